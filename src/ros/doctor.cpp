#include "semantic_mht_slam/ros/doctor.h"

#include <nav_msgs/Odometry.h>

#include <semantic_mht_slam/SemanticObjectArray.h>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/ros/diagnosis.h"

namespace semantic_mht_slam {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::string valueOf(const DiagnosticStatus& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& value : status.values) {
    if (value.key == key) return value.value;
  }
  return {};
}

/// "slam_node: odometry" -> "odometry".
std::string partOf(const DiagnosticStatus& status) {
  const std::size_t colon = status.name.rfind(": ");
  return colon == std::string::npos ? status.name : status.name.substr(colon + 2);
}

const DiagnosticStatus* findPart(const SystemObservation& system, const std::string& part) {
  for (const DiagnosticStatus& status : system.diagnostics) {
    if (partOf(status) == part) return &status;
  }
  return nullptr;
}

std::optional<Prescription> masterProblem(const SystemObservation& system) {
  if (system.has_master) return std::nullopt;
  return Prescription{"no ROS master at " + system.master_uri,
                      "start the system with roslaunch (or roscore), or set ROS_MASTER_URI to where it runs"};
}

std::optional<Prescription> nodeProblem(const SystemObservation& system) {
  if (!system.is_node_registered) {
    return Prescription{"the node " + system.node + " does not run",
                        "start it (roslaunch semantic_mht_slam slam.launch), or name it with --node NAME; 'rosnode "
                        "list' shows what runs"};
  }
  if (system.diagnostics.empty()) {
    return Prescription{"the node " + system.node + " is registered and says nothing on /diagnostics for " +
                            formatFixed(system.watched_s, 0) + " s",
                        "it died or hangs: look at its output, start it again; 'rosnode cleanup' forgets dead nodes"};
  }
  return std::nullopt;
}

std::optional<Prescription> timeProblem(const SystemObservation& system) {
  if (!system.use_sim_time && system.clock_publishers > 0) {
    return Prescription{"/clock is published and use_sim_time is false",
                        "run 'rosparam set use_sim_time true' and start the nodes again, or play without --clock"};
  }
  const DiagnosticStatus* odometry = findPart(system, "odometry");
  const bool has_run = odometry != nullptr && valueOf(*odometry, "messages") != "0";  // a bag that is over
  if (system.use_sim_time && system.clock_publishers == 0 && !has_run) {
    return Prescription{"use_sim_time is true and nobody publishes /clock",
                        "play the bag with --clock; live: 'rosparam set use_sim_time false' and start the nodes again"};
  }
  const DiagnosticStatus* clock = findPart(system, "clock");
  if (clock != nullptr && valueOf(*clock, "use_sim_time") != (system.use_sim_time ? "true" : "false")) {
    return Prescription{"use_sim_time was changed after the node " + system.node + " started", "start the node again"};
  }
  return std::nullopt;
}

/// How messages of another type come to the node.
std::string fixOfType(const std::string& part, const std::string& topic, const std::string& type,
                      const std::string& expected_type) {
  if (part == "objects") {
    return "roslaunch semantic_mht_slam object_relay.launch detections:=" + topic +
           ", and leave objects of slam.launch as it is (docs/object_relay.md)";
  }
  if (type == "geometry_msgs/PoseStamped") {
    return "rosrun semantic_mht_slam odometry_relay pose_in:=" + topic +
           " odometry:=/odometry, and slam.launch odometry:=/odometry";
  }
  return "remap " + part + ":= to a topic of that type ('rostopic find " + expected_type + "')";
}

std::string expectedMd5(const std::string& part) {
  return part == "objects" ? ros::message_traits::md5sum<SemanticObjectArray>()
                           : ros::message_traits::md5sum<nav_msgs::Odometry>();
}

/// What a topic carries instead, or where messages of its type can be had.
std::optional<Prescription> topicProblem(const SystemObservation& system, const std::string& part,
                                         const std::string& expected_type) {
  const DiagnosticStatus* status = findPart(system, part);
  if (status == nullptr || status->level == DiagnosticStatus::OK) return std::nullopt;
  const std::string topic = valueOf(*status, "topic");
  const auto type = system.type_of_topic.find(topic);
  if (type != system.type_of_topic.end() && type->second != expected_type) {
    return Prescription{topic + " carries " + type->second + ", expected is " + expected_type,
                        fixOfType(part, topic, type->second, expected_type)};
  }
  const auto version = system.md5_of_topic.find(topic);
  if (version != system.md5_of_topic.end() && version->second != expectedMd5(part)) {
    return Prescription{topic + " carries another version of " + expected_type + " than this node knows",
                        "build publisher and node of one version of the message, and source that workspace for both"};
  }
  if (valueOf(*status, "messages") != "0") return std::nullopt;
  std::vector<std::string> candidates;
  for (const auto& [name, candidate_type] : system.type_of_topic) {
    if (candidate_type == expected_type && name != topic) candidates.push_back(name);
  }
  if (candidates.empty()) return std::nullopt;
  return Prescription{status->message, "remap " + part + ":=" + candidates.front() +
                                           " (topics of this type: " + joined(candidates) + ")"};
}

std::optional<Prescription> diagnosedProblem(const SystemObservation& system, const std::string& part) {
  const DiagnosticStatus* status = findPart(system, part);
  if (status == nullptr || status->level == DiagnosticStatus::OK) return std::nullopt;
  return Prescription{status->message, valueOf(*status, kFixKey)};
}

}  // namespace

std::optional<Prescription> firstProblem(const SystemObservation& system) {
  if (auto problem = masterProblem(system)) return problem;
  if (auto problem = nodeProblem(system)) return problem;
  if (auto problem = timeProblem(system)) return problem;
  const std::map<std::string, std::string> types = {{"odometry", "nav_msgs/Odometry"},
                                                    {"objects", "semantic_mht_slam/SemanticObjectArray"}};
  for (const std::string part : {"clock", "odometry", "objects", "queue", "estimator"}) {
    const auto type = types.find(part);
    if (type != types.end()) {
      if (auto problem = topicProblem(system, part, type->second)) return problem;
    }
    if (auto problem = diagnosedProblem(system, part)) return problem;
  }
  return std::nullopt;
}

std::vector<std::string> notesOf(const SystemObservation& system) {
  std::vector<std::string> notes;
  for (const DiagnosticStatus& status : system.diagnostics) {
    for (const diagnostic_msgs::KeyValue& value : status.values) {
      if (value.key == kNoteKey) notes.push_back(value.value);
    }
  }
  return notes;
}

std::string summaryOf(const SystemObservation& system) {
  std::string summary;
  for (const DiagnosticStatus& status : system.diagnostics) {
    summary += "  " + partOf(status) + ": " + status.message + "\n";
  }
  return summary;
}

}  // namespace semantic_mht_slam
