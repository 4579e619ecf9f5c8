#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/evaluation/svg_plot.h"

namespace semantic_mht_slam {

/// A trajectory with its name in the legend.
struct NamedPath {
  std::string name;
  std::vector<Eigen::Vector3d> positions_m;
};

/// Paths of a camera seen from above, x right and z forward. The one named "truth" is drawn dark, one named "odometry"
/// dashed.
Plot trajectoryPlot(const std::vector<NamedPath>& paths);

/// Numbers of one run, one a frame that it knows, with its name in the legend.
struct NamedErrors {
  std::string name;
  std::vector<double> frames;
  std::vector<double> errors_m;
};

/// Errors over the frames.
Plot errorPlot(const std::string& title, const std::string& y_label, const std::vector<NamedErrors>& runs);

}  // namespace semantic_mht_slam
