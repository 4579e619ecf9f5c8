#pragma once

#include <string>

#include <semantic_mht_slam/MapUpdate.h>

#include "semantic_mht_slam/slam/map_delta.h"

namespace semantic_mht_slam {

/// Of a class table what two programs that speak of its classes must have in common.
std::uint64_t digestOf(const ClassTable& classes);

/// A submap as a message, but for `header.frame_id` and `map_id`. What it leaves out: positions below a hundredth of
/// the detector's reference range, correlations of landmarks' positions, sizes of landmarks.
MapUpdate toMessage(const SlamParts& parts, SubmapId submap, const ClassTable& classes);

/// All finished submaps, with `header.frame_id`.
std::vector<MapUpdate> toMessages(const MapContent& content, const ClassTable& classes, const std::string& map_frame);

/// How many objects its keyframes show, all together.
std::size_t shownObjects(const MapUpdate& message);

/// Throws InputError with the field that cannot be used.
MapDelta fromMessage(const MapUpdate& message, const ClassTable& classes);

/// `closures_held` as one value a closure.
std::vector<bool> heldClosures(const MapUpdate& message);

}  // namespace semantic_mht_slam
