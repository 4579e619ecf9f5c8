#include "semantic_mht_slam/io/g2o_report.h"

#include <nlohmann/json.hpp>

namespace semantic_mht_slam {

std::string formatReport(const G2oFile& file, const G2oReport& report) {
  nlohmann::ordered_json json;
  const BatchReport& solver = report.solver;
  json["initial_cost"] = solver.initial_cost;
  json["final_cost"] = solver.final_cost;
  json["accepted_cost"] = solver.accepted_cost;
  json["iterations"] = solver.iterations;
  json["converged"] = solver.converged;
  json["start"] = solver.started_from_chordal_guess ? "chordal" : "given";
  json["start_cost"] = solver.start_cost;
  json["seconds"] = report.seconds;
  json["cpu_seconds"] = report.cpu_seconds;
  std::visit(
      [&](const auto& graph) {
        json["vertices"] = graph.poses.size();
        json["points"] = graph.points.size();
        json["edges"] = graph.pose_edges.size() + graph.point_edges.size();
        json["rejected_loops"] = nlohmann::ordered_json::array();
        for (const RejectedLoop& loop : solver.rejected_loops) {
          const auto& edge = graph.pose_edges[loop.edge];
          json["rejected_loops"].push_back({{"from", graph.poses[edge.from].id},
                                            {"to", graph.poses[edge.to].id},
                                            {"mahalanobis_sq", loop.mahalanobis_sq}});
        }
      },
      file.graph);
  json["projected_edges"] = file.projected_edges;
  return json.dump(2) + "\n";
}

}  // namespace semantic_mht_slam
