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

/// The axes of the ground plane of a frame.
enum class GroundPlane {
  kXForwardYLeft,  ///< base frames: x over y
  kXRightZForward  ///< camera frames: x over z
};

/// Paths seen from above. The one named "truth" is drawn dark, one named "odometry" dashed.
Plot trajectoryPlot(const std::vector<NamedPath>& paths, GroundPlane plane);

/// Numbers of one run, one a frame, with its name in the legend.
struct NamedErrors {
  std::string name;
  std::vector<double> errors_m;
};

/// Errors over the frames.
Plot errorPlot(const std::string& title, const std::string& y_label, const std::vector<NamedErrors>& runs);

}  // namespace semantic_mht_slam
