#pragma once

#include <variant>

#include "semantic_mht_slam/slam/localizer.h"

namespace semantic_mht_slam {

/// What is seen goes into the map.
struct Mapping {};

/// The map stays as it is, and the vehicle finds itself in it.
struct Localizing {
  Localizer localizer;
  bool until_found = false;  ///< then mapping goes on; false: localization was chosen
};

/// The map stays as it is while the vehicle is at places that were mapped `localization.known_passes` times.
struct Following {
  Localizer localizer;
};

using Mode = std::variant<Mapping, Localizing, Following>;

/// Null while mapping.
const Localizer* localizerOf(const Mode& mode);
Localizer* localizerOf(Mode& mode);

/// True if the map is not added to: by choice, or because the vehicle is not found yet.
bool isLocalizing(const Mode& mode);

/// True if the map is not added to because the place is known.
bool isFollowing(const Mode& mode);

/// True if the vehicle knows where it is in the map.
bool isLocated(const Mode& mode);

}  // namespace semantic_mht_slam
