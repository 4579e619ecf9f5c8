#include "semantic_mht_slam/app/refused_input.h"

#include <algorithm>

#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMostListed = 10;

}  // namespace

std::string UnknownClassList::text() const {
  if (listed.empty()) return {};
  std::vector<std::string> ids;
  for (const auto& [id, count] : listed) ids.push_back(std::to_string(id));
  return (ids.size() == 1 ? "class id " : "class ids ") + joined(ids) +
         (others > 0 ? " and " + std::to_string(others) + " more" : "");
}

UnknownClassList listOf(const std::map<int, std::size_t>& unknown_classes) {
  std::vector<std::pair<int, std::size_t>> by_objects(unknown_classes.begin(), unknown_classes.end());
  std::stable_sort(by_objects.begin(), by_objects.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  UnknownClassList list;
  for (const auto& [id, count] : by_objects) {
    if (list.listed.size() < kMostListed) {
      list.listed[id] = count;
    } else {
      ++list.others;
      list.objects_of_others += count;
    }
  }
  return list;
}

std::vector<std::string> droppedInput(const InputCounters& counters, const RefusedInput& refused,
                                      const InputNames& names) {
  std::vector<std::string> lines;
  const auto report = [&](std::size_t count, const std::string& name, const std::string& problem) {
    if (count > 0) lines.push_back(name + ": " + std::to_string(count) + " " + problem);
  };
  const auto odometry = [&](std::size_t count, const std::string& problem) {
    report(count, names.odometry, "messages dropped: " + problem);
  };
  const auto objects = [&](std::size_t count, const std::string& problem) {
    report(count, names.objects, "messages dropped: " + problem);
  };
  odometry(refused.odometry_wrong_frames,
           "from " + refused.wrong_frames + ", other frames than node.odom_frame and node.base_frame");
  odometry(refused.odometry_bad_stamps, "the stamp is zero, or beyond the end of ROS's time");
  odometry(refused.odometry_stamp_outliers, "the stamp is far from those of the messages before and after");
  odometry(refused.odometry_before_jump, "the clock falls back after them, and a new map begins");
  odometry(counters.odometry_invalid, "not finite, beyond 1e10 m, or a quaternion without unit norm");
  odometry(counters.odometry_not_rising, "the stamp does not rise");
  odometry(counters.odometry_outliers, "no motion leads there, and the next message goes on without it");
  objects(refused.objects_before_jump, "the clock falls back after them, and a new map begins");
  objects(refused.objects_bad_stamps, "the stamp is zero, or beyond the end of ROS's time");
  objects(refused.objects_without_transform,
          "no transform from '" + refused.unconnected_frame + "' to '" + names.base_frame + "' at their stamp");
  objects(refused.objects_given_up, "they waited for odometry or tf, until too many did or another map began");
  objects(refused.objects_in_map_frame,
          "given in the frame of the map, which is what is sought; the sensor's is needed");
  const UnknownClassList unknown = listOf(refused.unknown_classes);
  for (const auto& [id, count] : unknown.listed) {
    report(count, names.objects, "objects dropped: class id '" + std::to_string(id) + "' is not in the class table");
  }
  report(unknown.objects_of_others, names.objects,
         "objects dropped: of other class ids that are not in the class table, " + std::to_string(unknown.others) +
             " more");
  report(counters.detections_invalid, names.objects,
         "objects dropped: position, covariance, score or size is unusable");
  report(counters.detections_at_origin, names.objects, "objects dropped: they lie at exactly 0, 0, 0");
  objects(counters.frames_before_odometry, "older than the odometry");
  objects(counters.frames_not_rising, "the stamp does not rise");
  objects(counters.frames_far_ahead, "the stamp is far ahead of the odometry");
  objects(counters.frames_in_odometry_gap, "in a gap of the odometry (input.max_odometry_gap)");
  objects(counters.frames_waiting_too_long, "no odometry came for them in time, or before another session began");
  return lines;
}

std::vector<std::string> droppedFixes(const GnssCounters& counters, const RefusedInput& refused,
                                      const InputNames& names) {
  std::vector<std::string> lines;
  const auto dropped = [&](std::size_t count, const std::string& problem) {
    if (count > 0) lines.push_back(names.fixes + ": " + std::to_string(count) + " fixes dropped: " + problem);
  };
  dropped(counters.no_fix, "the receiver says that it has none");
  dropped(counters.invalid, "not finite, not on the Earth, or an antenna 1 km away");
  dropped(counters.too_coarse, "the horizontal standard deviation is beyond 10 km");
  dropped(counters.null_island, "latitude and longitude are both zero");
  dropped(counters.bad_stamps + refused.fixes_bad_stamps,
          "the stamp is zero, negative, or beyond the end of ROS's time");
  dropped(counters.repeated, "there is another one of the same stamp");
  dropped(counters.late, "they came after their keyframes had been looked at (gnss.max_delay)");
  dropped(counters.far_ahead, "the stamp is far ahead of the odometry");
  dropped(counters.far_away, "nowhere near the other fixes");
  dropped(counters.no_odometry, "in a gap of the odometry");
  dropped(counters.crowded_out, "too many waited for keyframes");
  dropped(refused.fixes_without_mapping, "while the vehicle localizes, or before odometry that may begin a session");
  if (refused.fixes_without_transform > 0) {
    lines.push_back(names.fixes + ": no transform from '" + refused.antenna_frame + "' to '" + names.base_frame +
                    "'; the antenna is taken to be where gnss.antenna_x, _y and _z have it");
  }
  return lines;
}

}  // namespace semantic_mht_slam
