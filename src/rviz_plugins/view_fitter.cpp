#include "view_fitter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <rviz/properties/property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>

namespace semantic_mht_slam {
namespace {

constexpr double kInView = 0.65;  // of the map's diagonal, on each side of the vehicle, which is seldom at an end
constexpr float kStep = 1.4F;     // a map that grows by less does not change the view
constexpr float kSame = 1e-3F;

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

}  // namespace semantic_mht_slam
