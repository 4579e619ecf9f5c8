#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticStatus.h>

namespace semantic_mht_slam {

/// What one sees of a running system from outside.
struct SystemObservation {
  std::string master_uri;
  bool has_master = false;
  std::string node;  ///< name of the node that is looked at, "/slam_node"
  bool is_node_registered = false;
  double watched_s = 0.0;
  bool use_sim_time = false;
  std::size_t clock_publishers = 0;
  std::map<std::string, std::string> type_of_topic;            ///< published topics
  std::map<std::string, std::string> md5_of_topic;             ///< of the messages of input that does not arrive
  std::vector<diagnostic_msgs::DiagnosticStatus> diagnostics;  ///< the node's newest, in the node's order
};

/// What is wrong, and what to do about it.
struct Prescription {
  std::string problem;
  std::string fix;
};

/// The first thing that is wrong, in the order in which one would mend things: master, node, time, odometry, objects.
std::optional<Prescription> firstProblem(const SystemObservation& system);

/// What is no fault, but may not be what was meant.
std::vector<std::string> notesOf(const SystemObservation& system);

/// The messages of the node's diagnostics, a line each.
std::string summaryOf(const SystemObservation& system);

/// Looks at the system that ROS_MASTER_URI names for `watch_s` of wall time, if there is a node to watch. ros::init
/// must have been called.
SystemObservation observeSystem(const std::string& node, double watch_s);

}  // namespace semantic_mht_slam
