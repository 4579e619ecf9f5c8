#pragma once

#include <optional>

#include <semantic_mht_slam/SemanticMap.h>

namespace rviz {
class VisualizationManager;
}

namespace semantic_mht_slam {

/// Keeps a map in view: sets the scale of rviz's view from above, until the user sets another one.
class ViewFitter {
 public:
  /// `rviz` may be null: then nothing is done.
  void fit(const SemanticMap& map, rviz::VisualizationManager* rviz);

 private:
  std::optional<float> scale_;  ///< the one that was set, pixels/m; empty before the first map
  bool is_users_ = false;
};

/// Scale in pixels/m at which most of a map is in the smaller side of a view with the vehicle in its middle; empty for
/// a map of fewer than two landmarks.
std::optional<double> fittingScale(const SemanticMap& map, int width_px, int height_px);

}  // namespace semantic_mht_slam
