#include "semantic_mht_slam/slam/place_units.h"

#include <utility>

namespace semantic_mht_slam {

Pose PlaceUnits::toPlaces(Pose pose) const {
  pose.translation_m /= factor_;
  return pose;
}

Scene PlaceUnits::toPlaces(Scene scene) const {
  for (SceneObject& object : scene.objects) {
    object.position_m /= factor_;
    object.cov_m2 /= factor_ * factor_;
  }
  return scene;
}

Keyframe PlaceUnits::toPlaces(Keyframe keyframe) const {
  keyframe.driven_m = toPlaces(keyframe.driven_m);
  keyframe.scene = toPlaces(std::move(keyframe.scene));
  return keyframe;
}

RegistrationConfig PlaceUnits::toPlaces(RegistrationConfig config) const {
  for (Length* length :
       {&config.max_offset_m, &config.max_window_m, &config.cell_m, &config.noise_floor_m, &config.height_stddev_m,
        &config.density_radius_m, &config.density_height_m, &config.distinct_m}) {
    *length = toPlaces(*length);
  }
  return config;
}

PlaceMatch PlaceUnits::fromPlaces(PlaceMatch match) const {
  match.T_match_query.translation_m *= factor_;
  match.cov.topRows<3>() *= factor_;
  match.cov.leftCols<3>() *= factor_;
  return match;
}

}  // namespace semantic_mht_slam
