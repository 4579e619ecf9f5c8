/// \file
/// Optimises a pose-graph file: optimize_g2o FILE.g2o --output OUT.g2o [--robust cauchy] [--report FILE.json].

#include <ctime>
#include <exception>
#include <iostream>
#include <optional>
#include <string>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/stopwatch.h"
#include "semantic_mht_slam/graph/batch_solver.h"
#include "semantic_mht_slam/io/g2o_file.h"
#include "semantic_mht_slam/io/g2o_report.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

struct Arguments {
  std::string input;
  std::string output;
  std::string report;
  BadInformation bad_information = BadInformation::kRefuse;
  BatchOptions options;
};

po::options_description visibleOptions() {
  po::options_description options("Options");
  options.add_options()                                                                         //
      ("help,h", "print this text")                                                             //
      ("output,o", po::value<std::string>(), "optimised graph, g2o")                            //
      ("report", po::value<std::string>(), "costs, iterations, seconds, rejected loops; JSON")  //
      ("robust", po::value<std::string>()->default_value("none"),
       "none | cauchy: loop closures outside the largest consistent set are left out, the others and landmarks get a "
       "Cauchy loss")                                                                         //
      ("keep-all-loops", "with --robust cauchy: no consistency test between loop closures")   //
      ("max-iterations", po::value<int>()->default_value(100), "limit of each optimisation")  //
      ("project-information", "repair information matrices that are not positive definite instead of refusing them");
  return options;
}

void printHelp() {
  std::cout << "Optimises a pose graph with SE2 or SE3 vertices and edges, landmark edges where present.\n"
               "usage: optimize_g2o FILE.g2o --output OUT.g2o [options]\n"
            << visibleOptions();
}

/// Empty if only help was asked for. Throws InputError or boost::program_options::error.
std::optional<Arguments> parseArguments(int argc, char** argv) {
  po::options_description all = visibleOptions();
  all.add_options()("input", po::value<std::string>());
  po::positional_options_description positional;
  positional.add("input", 1);
  po::command_line_parser parser(argc, argv);
  parser.options(all).positional(positional);
  parser.style(po::command_line_style::unix_style & ~po::command_line_style::allow_guessing);
  po::variables_map values;
  po::store(parser.run(), values);
  if (values.count("help") > 0) return std::nullopt;
  Arguments arguments;
  if (values.count("input") == 0) throw InputError("no input file; see --help");
  if (values.count("output") == 0) throw InputError("--output is missing; see --help");
  arguments.input = values["input"].as<std::string>();
  arguments.output = values["output"].as<std::string>();
  if (values.count("report") > 0) arguments.report = values["report"].as<std::string>();
  const std::string robust = values["robust"].as<std::string>();
  if (robust != "none" && robust != "cauchy") throw InputError("--robust is none or cauchy, not '" + robust + "'");
  arguments.options.cauchy = robust == "cauchy";
  arguments.options.reject_inconsistent_loops = arguments.options.cauchy && values.count("keep-all-loops") == 0;
  arguments.options.max_iterations = values["max-iterations"].as<int>();
  if (arguments.options.max_iterations < 0) throw InputError("--max-iterations is negative");
  if (values.count("project-information") > 0) arguments.bad_information = BadInformation::kProject;
  return arguments;
}

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

template <int kDim>
G2oReport optimize(BatchGraph<kDim>& graph, const BatchOptions& options) {
  const Stopwatch watch;
  const double cpu_start_s = cpuSeconds();
  G2oReport report;
  report.solver = optimizeBatch(graph, options);
  report.cpu_seconds = cpuSeconds() - cpu_start_s;
  report.seconds = watch.elapsed_s();
  return report;
}

int run(const Arguments& arguments) {
  G2oFile file = readG2o(arguments.input, arguments.bad_information);
  const G2oReport report = std::visit([&](auto& graph) { return optimize(graph, arguments.options); }, file.graph);
  if (!report.solver.failure.empty()) throw InputError(arguments.input + ": " + report.solver.failure);
  writeFileAtomically(arguments.output, formatG2o(file));
  if (!arguments.report.empty()) writeFileAtomically(arguments.report, formatReport(file, report));
  std::cout << "F " << report.solver.initial_cost << " -> " << report.solver.final_cost << ", "
            << report.solver.iterations << " iterations, " << report.seconds << " s";
  if (arguments.options.reject_inconsistent_loops) {
    std::cout << ", " << report.solver.rejected_loops.size() << " loop closures rejected";
  }
  if (!file.projected_edges.empty()) {
    std::cout << ", " << file.projected_edges.size() << " information matrices repaired";
  }
  std::cout << (report.solver.converged ? "\n" : ", not converged\n");
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  using namespace semantic_mht_slam;
  try {
    const auto arguments = parseArguments(argc, argv);
    if (!arguments) {
      printHelp();
      return 0;
    }
    return run(*arguments);
  } catch (const std::exception& error) {
    std::cerr << "optimize_g2o: " << error.what() << '\n';
    return 1;
  }
}
