#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "semantic_mht_slam/slam/frame_assembler.h"
#include "semantic_mht_slam/slam/gnss_fixes.h"

namespace semantic_mht_slam {

/// What was refused before it came to the estimator, by cause; the estimator counts the rest (`InputCounters`).
struct RefusedInput {
  std::size_t odometry_wrong_frames = 0;
  std::string wrong_frames;                 ///< the newest ones, "'camera_init' to 'camera'"
  std::size_t odometry_bad_stamps = 0;      ///< zero, or in the last hour of ROS's time
  std::size_t odometry_stamp_outliers = 0;  ///< one message stamped far from those before and after it
  std::size_t objects_bad_stamps = 0;
  std::size_t objects_without_transform = 0;
  std::string unconnected_frame;         ///< the newest one
  std::size_t objects_given_up = 0;      ///< waited for odometry or tf when too many did, or a map was loaded or reset
  std::size_t objects_in_map_frame = 0;  ///< in the frame of the map, or in one that hangs on it
  std::size_t odometry_before_jump = 0;  ///< of a bag: time fell back after it, and another map began
  std::size_t objects_before_jump = 0;
  std::map<int, std::size_t> unknown_classes;  ///< class id -> objects dropped
  std::size_t fixes_bad_stamps = 0;
  std::size_t fixes_without_mapping = 0;    ///< while one localizes, or before odometry that may begin a session
  std::size_t fixes_without_transform = 0;  ///< taken with the antenna where the parameters have it
  std::string antenna_frame;                ///< the newest one of these
};

/// Class ids that the table lacks, as far as they are listed: whoever sends garbage sends many.
struct UnknownClassList {
  std::map<int, std::size_t> listed;  ///< class id -> objects dropped; the ten ids of most objects
  std::size_t others = 0;             ///< ids beside them
  std::size_t objects_of_others = 0;  ///< dropped

  /// "class id 7", "class ids 7, 99 and 3 more"; empty if there are none.
  std::string text() const;
};

UnknownClassList listOf(const std::map<int, std::size_t>& unknown_classes);

/// Names of the input in messages to the user: topics or files, and the robot's frame.
struct InputNames {
  std::string odometry = "odometry";
  std::string objects = "objects";
  std::string base_frame = "base_link";
  std::string fixes = "fixes";
};

/// What was dropped of the two inputs so far, a line for each cause: the input, how many, and why. Unknown classes have
/// a line each, as far as they are listed, and one for all others.
std::vector<std::string> droppedInput(const InputCounters& counters, const RefusedInput& refused,
                                      const InputNames& names);

/// The same of positions by satellites.
std::vector<std::string> droppedFixes(const GnssCounters& counters, const RefusedInput& refused,
                                      const InputNames& names);

}  // namespace semantic_mht_slam
