#include "view_fitter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <rviz/properties/tf_frame_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>

namespace semantic_mht_slam {
namespace {

constexpr double kInView = 0.65;  // of the map's diagonal, on each side of the vehicle, which is seldom at an end
constexpr float kStep = 1.4F;     // a map that grows by less does not change the view
constexpr float kSame = 1e-3F;
constexpr const char* kAxes[] = {"X", "Y", "Z"};

/// Null if there is none: subProp would print an error.
rviz::Property* childOf(const rviz::Property& parent, const QString& name) {
  for (int i = 0; i < parent.numChildren(); ++i) {
    rviz::Property* child = parent.childAt(i);
    if (child->getName() == name) return child;
  }
  return nullptr;
}

/// The property with the X and Y at which a view looks; null for views that look from a place of their own.
rviz::Property* placeOf(rviz::Property& view) {
  if (rviz::Property* focal_point = childOf(view, "Focal Point")) return focal_point;
  return childOf(view, "Scale") != nullptr ? &view : nullptr;
}

bool hasTarget(const rviz::Property& view, const QString& frame) {
  const rviz::Property* target = childOf(view, "Target Frame");
  return target != nullptr && target->getValue().toString() == frame;
}

/// Those coordinates that the place of a view has; 0 for the others.
Eigen::Vector3d positionOf(const rviz::Property& place) {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (const rviz::Property* value = childOf(place, kAxes[axis])) position_m[axis] = value->getValue().toDouble();
  }
  return position_m;
}

void moveTo(const Eigen::Vector3d& position_m, const rviz::Property& place) {
  for (int axis = 0; axis < 3; ++axis) {
    if (rviz::Property* value = childOf(place, kAxes[axis])) value->setValue(static_cast<float>(position_m[axis]));
  }
}

}  // namespace

std::optional<double> fittingScale(const SemanticMap& map, int width_px, int height_px) {
  Eigen::AlignedBox2d box;
  for (const Landmark& landmark : map.landmarks) box.extend(Eigen::Vector2d(landmark.position.x, landmark.position.y));
  if (box.isEmpty() || !(box.sizes().norm() > 0.0)) return std::nullopt;
  return 0.5 * std::min(width_px, height_px) / (kInView * box.sizes().norm());
}

void ViewFitter::fit(const SemanticMap& map, rviz::VisualizationManager* rviz) {
  if (rviz == nullptr || is_users_) return;
  rviz::ViewController* view = rviz->getViewManager()->getCurrent();
  if (view == nullptr || view->getClassId() != "rviz/TopDownOrtho") return;
  if (hasTarget(*view, QString::fromStdString(map.header.frame_id))) return;
  rviz::Property* scale = view->subProp("Scale");
  const float present = scale->getValue().toFloat();
  is_users_ = scale_ && std::abs(present - *scale_) > kSame * *scale_;
  const std::optional<double> wanted =
      fittingScale(map, rviz->getRenderPanel()->width(), rviz->getRenderPanel()->height());
  if (is_users_ || !wanted) return;
  const auto next = static_cast<float>(*wanted);
  if (scale_ && next < kStep * *scale_ && next * kStep > *scale_) return;
  scale->setValue(next);
  scale_ = next;
}

void ViewFitter::follow(const geometry_msgs::PoseWithCovarianceStamped& pose, const rviz::VisualizationManager* rviz) {
  if (rviz == nullptr || rviz->getFixedFrame().toStdString() != pose.header.frame_id) return;
  rviz::ViewController* view = rviz->getViewManager()->getCurrent();
  const geometry_msgs::Point& vehicle = pose.pose.pose.position;
  if (view != nullptr) follow(Eigen::Vector3d(vehicle.x, vehicle.y, vehicle.z), *view);
}

void ViewFitter::follow(const Eigen::Vector3d& vehicle_m, rviz::Property& view) {
  rviz::Property* place = hasTarget(view, rviz::TfFrameProperty::FIXED_FRAME_STRING) ? placeOf(view) : nullptr;
  const bool is_new = followed_ != &view;
  followed_ = place == nullptr ? nullptr : &view;
  if (place == nullptr) return;
  offset_m_ = is_new ? Eigen::Vector3d::Zero() : Eigen::Vector3d(offset_m_ + positionOf(*place) - place_m_);
  moveTo(vehicle_m + offset_m_, *place);
  place_m_ = positionOf(*place);  // rounded as it is there: what differs later is the user's
}

}  // namespace semantic_mht_slam
