#include "semantic_mht_slam/evaluation/trajectory_plot.h"

#include <utility>

namespace semantic_mht_slam {

Plot trajectoryPlot(const std::vector<NamedPath>& paths) {
  Plot plot;
  plot.title = "Trajectory";
  plot.x_label = "x [m]";
  plot.y_label = "z [m]";
  plot.equal_aspect = true;
  for (const NamedPath& path : paths) {
    PlotSeries series;
    series.label = path.name;
    if (path.name == "truth") series.color = "#333333";
    if (path.name == "odometry") series.style = PlotSeries::Style::kDashed;
    for (const Eigen::Vector3d& position_m : path.positions_m) {
      series.x.push_back(position_m.x());
      series.y.push_back(position_m.z());
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot errorPlot(const std::string& title, const std::string& y_label, const std::vector<NamedErrors>& runs) {
  Plot plot;
  plot.title = title;
  plot.x_label = "frame";
  plot.y_label = y_label;
  plot.y_from_zero = true;
  for (const NamedErrors& run : runs) {
    PlotSeries series;
    series.label = run.name;
    series.x = run.frames;
    series.y = run.errors_m;
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace semantic_mht_slam
