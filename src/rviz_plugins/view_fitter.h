#pragma once

#include <QPointer>
#include <optional>

#include <Eigen/Core>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <rviz/properties/property.h>

#include <semantic_mht_slam/SemanticMap.h>

namespace rviz {
class VisualizationManager;
}

namespace semantic_mht_slam {

/// Keeps the map and the vehicle in view: sets the scale of rviz's view from above, until the user sets another one,
/// and moves the view along with the vehicle, by the topic `pose`: nobody need publish the vehicle's frame on tf. A
/// view whose target frame is by name that of the map looks at a place of the map, and stays as it is.
class ViewFitter {
 public:
  /// `rviz` may be null: then nothing is done.
  void fit(const SemanticMap& map, rviz::VisualizationManager* rviz);

  /// Moves rviz's present view to the vehicle if the pose is in rviz's fixed frame. `rviz` may be null.
  void follow(const geometry_msgs::PoseWithCovarianceStamped& pose, const rviz::VisualizationManager* rviz);

  /// The same for a view, from above or around a focal point, whose target is the fixed frame; others stay as they are.
  /// A view that is new begins at the vehicle. As far as the user has moved it from there since, it stays away.
  void follow(const Eigen::Vector3d& vehicle_m, rviz::Property& view);

 private:
  std::optional<float> scale_;  ///< the one that was set, pixels/m; empty before the first map
  bool is_users_ = false;
  QPointer<rviz::Property> followed_;                   ///< the view that was moved last
  Eigen::Vector3d place_m_ = Eigen::Vector3d::Zero();   ///< that it was moved to, as it has it
  Eigen::Vector3d offset_m_ = Eigen::Vector3d::Zero();  ///< of the view from the vehicle, by the user
};

/// Scale in pixels/m at which most of a map is in the smaller side of a view with the vehicle in its middle; empty for
/// a map of fewer than two landmarks.
std::optional<double> fittingScale(const SemanticMap& map, int width_px, int height_px);

}  // namespace semantic_mht_slam
