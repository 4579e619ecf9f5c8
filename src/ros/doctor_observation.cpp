#include <XmlRpcValue.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include "semantic_mht_slam/ros/diagnosis.h"
#include "semantic_mht_slam/ros/doctor.h"

namespace semantic_mht_slam {
namespace {

constexpr double kPoll_s = 0.05;
constexpr double kListen_s = 2.0;  // for a message that shows its version

/// Publishers of a topic, as the master knows them.
std::size_t publishersOf(const std::string& topic) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return 0;
  XmlRpc::XmlRpcValue& publishers = state[0];
  for (int i = 0; i < publishers.size(); ++i) {
    if (static_cast<std::string>(publishers[i][0]) == topic) return static_cast<std::size_t>(publishers[i][1].size());
  }
  return 0;
}

/// Statuses of the node, the newest of each name in the order in which the node has them.
void keepNewest(const diagnostic_msgs::DiagnosticArray& array, const std::string& node,
                std::vector<diagnostic_msgs::DiagnosticStatus>& newest) {
  std::vector<diagnostic_msgs::DiagnosticStatus> own;
  for (const diagnostic_msgs::DiagnosticStatus& status : array.status) {
    const bool is_own = "/" + status.name.substr(0, status.name.rfind(": ")) == node;
    if (is_own && status.hardware_id == kDiagnosticsHardwareId) own.push_back(status);
  }
  if (!own.empty()) newest = std::move(own);
}

/// Of a message on each topic that the node has nothing from.
std::map<std::string, std::string> versionsOfSilent(const std::vector<diagnostic_msgs::DiagnosticStatus>& statuses) {
  std::map<std::string, std::string> md5_of_topic;
  std::vector<ros::Subscriber> subscribers;
  ros::NodeHandle handle;
  for (const diagnostic_msgs::DiagnosticStatus& status : statuses) {
    std::map<std::string, std::string> values;
    for (const diagnostic_msgs::KeyValue& value : status.values) values[value.key] = value.value;
    if (values.count("topic") == 0 || values["messages"] != "0") continue;
    const std::string topic = values["topic"];
    subscribers.push_back(handle.subscribe<topic_tools::ShapeShifter>(
        topic, 1, [&md5_of_topic, topic](const topic_tools::ShapeShifter::ConstPtr& message) {
          md5_of_topic[topic] = message->getMD5Sum();
        }));
  }
  const ros::WallTime begin = ros::WallTime::now();
  while (ros::ok() && md5_of_topic.size() < subscribers.size() && (ros::WallTime::now() - begin).toSec() < kListen_s) {
    ros::spinOnce();
    ros::WallDuration(kPoll_s).sleep();
  }
  return md5_of_topic;
}

}  // namespace

SystemObservation observeSystem(const std::string& node, double watch_s) {
  SystemObservation system;
  system.master_uri = ros::master::getURI();
  system.node = node;
  system.has_master = ros::master::check();
  if (!system.has_master) return system;
  ros::V_string nodes;
  ros::master::getNodes(nodes);
  for (const std::string& name : nodes) system.is_node_registered = system.is_node_registered || name == node;
  if (!system.is_node_registered) return system;

  ros::NodeHandle handle;
  const auto subscriber = handle.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 100,
      [&](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { keepNewest(*message, node, system.diagnostics); });
  const ros::WallTime begin = ros::WallTime::now();
  while (ros::ok() && (ros::WallTime::now() - begin).toSec() < watch_s) {
    ros::spinOnce();
    ros::WallDuration(kPoll_s).sleep();
  }
  system.watched_s = watch_s;
  ros::param::get("/use_sim_time", system.use_sim_time);
  system.clock_publishers = publishersOf("/clock");
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  for (const ros::master::TopicInfo& topic : topics) system.type_of_topic[topic.name] = topic.datatype;
  system.md5_of_topic = versionsOfSilent(system.diagnostics);
  return system;
}

}  // namespace semantic_mht_slam
