#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "semantic_mht_slam/app/refused_input.h"
#include "semantic_mht_slam/slam/gnss_fixes.h"

namespace semantic_mht_slam {

/// What became of the fixes of a run, and where the map is on the Earth by them; empty if there were none.
std::optional<nlohmann::ordered_json> gnssReport(const GnssCounters& counters, const RefusedInput& refused,
                                                 const InputNames& names, const std::optional<GeoReference>& reference);

}  // namespace semantic_mht_slam
