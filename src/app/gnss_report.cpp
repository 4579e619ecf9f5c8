#include "gnss_report.h"

#include "semantic_mht_slam/app/landmark_files.h"

namespace semantic_mht_slam {

std::optional<nlohmann::ordered_json> gnssReport(const GnssCounters& counters, const RefusedInput& refused,
                                                 const InputNames& names,
                                                 const std::optional<GeoReference>& reference) {
  if (counters.received == 0 && refused.fixes_bad_stamps == 0 && refused.fixes_without_mapping == 0)
    return std::nullopt;
  nlohmann::ordered_json report = {{"received", counters.received},
                                   {"used", counters.used},
                                   {"covariances_unknown", counters.covariances_unknown},
                                   {"no_fix", counters.no_fix},
                                   {"invalid", counters.invalid},
                                   {"too_coarse", counters.too_coarse},
                                   {"null_island", counters.null_island},
                                   {"bad_stamps", counters.bad_stamps + refused.fixes_bad_stamps},
                                   {"repeated", counters.repeated},
                                   {"late", counters.late},
                                   {"far_ahead", counters.far_ahead},
                                   {"far_away", counters.far_away},
                                   {"no_odometry", counters.no_odometry},
                                   {"crowded_out", counters.crowded_out},
                                   {"without_mapping", refused.fixes_without_mapping},
                                   {"without_transform", refused.fixes_without_transform},
                                   {"dropped", droppedFixes(counters, refused, names)},
                                   {"is_map_placed", reference.has_value()}};
  if (!reference) return report;
  const MapOrigin map = originOf(*reference);
  report["map_origin"] = {
      {"latitude", map.latitude_deg}, {"longitude", map.longitude_deg}, {"heading", map.heading_rad}};
  return report;
}

}  // namespace semantic_mht_slam
