#pragma once

#include <vector>

#include "semantic_mht_slam/map/keyframe.h"
#include "semantic_mht_slam/place/place_match.h"
#include "semantic_mht_slam/registration/registration_config.h"

namespace semantic_mht_slam {

/// The lengths of place recognition are those of a detector that sees as far as the reference (see `Length`). What goes
/// in is divided by how much farther the present one sees, what comes out is multiplied by it; with a factor of 1
/// nothing changes.
class PlaceUnits {
 public:
  explicit PlaceUnits(double factor) : factor_(factor) {}

  double toPlaces(double length_m) const { return length_m / factor_; }
  Pose toPlaces(Pose pose) const;
  Scene toPlaces(Scene scene) const;
  Keyframe toPlaces(Keyframe keyframe) const;
  RegistrationConfig toPlaces(RegistrationConfig config) const;
  double fromPlaces(double length_m) const { return length_m * factor_; }
  PlaceMatch fromPlaces(PlaceMatch match) const;

 private:
  double factor_;
};

}  // namespace semantic_mht_slam
