#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/AddMap.h>
#include <semantic_mht_slam/MergeStatus.h>
#include <semantic_mht_slam/RemoveMap.h>
#include <semantic_mht_slam/SaveMap.h>
#include <semantic_mht_slam/SemanticMap.h>

#include "support/running_node.h"

namespace semantic_mht_slam {

/// A map_server of its own for a test, and what it says.
class RunningServer {
 public:
  RunningServer(const std::string& name, std::vector<std::string> parameters)
      : name_(name), handle_("/" + name), transforms_(buffer_) {
    status_subscriber_ = handle_.subscribe<MergeStatus>("merge_status", 10, &RunningServer::takeStatus, this);
    map_subscriber_ = handle_.subscribe<SemanticMap>("world/map", 10, &RunningServer::takeMap, this);
    markers_subscriber_ =
        handle_.subscribe<visualization_msgs::MarkerArray>("world/markers", 10, &RunningServer::takeMarkers, this);
    diagnostics_subscriber_ =
        handle_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, &RunningServer::takeDiagnostics, this);
    parameters.insert(parameters.begin(), {"__name:=map_server", "__ns:=/" + name});
    process_ = std::make_unique<RosProcess>("map_server", parameters);
  }

  RosProcess& process() { return *process_; }

  template <class Service>
  typename Service::Response call(const std::string& service, const typename Service::Request& request) {
    Service call;
    call.request = request;
    const std::string full = "/" + name_ + "/map_server/" + service;
    EXPECT_TRUE(ros::service::waitForService(full, ros::Duration(20.0)));
    EXPECT_TRUE(callService(full, call));
    EXPECT_FALSE(call.response.message.empty());
    return call.response;
  }

  AddMap::Response add(const std::string& path, const std::string& name = "") {
    AddMap::Request request;
    request.path = path;
    request.name = name;
    return call<AddMap>("add_map", request);
  }

  RemoveMap::Response remove(const std::string& name, const std::string& service = "remove_map") {
    RemoveMap::Request request;
    request.name = name;
    return call<RemoveMap>(service, request);
  }

  /// Waits until the newest result is one of which this holds.
  template <class Predicate>
  bool comesTo(const Predicate& isTrue) {
    return waitFor(
        [&] {
          const std::lock_guard<std::mutex> lock(mutex_);
          return status_ && !status_->is_merging && isTrue(*status_);
        },
        60.0);
  }

  /// Waits until the maps have these states, by their names.
  bool comesTo(const std::map<std::string, int>& states) {
    return comesTo([&](const MergeStatus& status) {
      std::map<std::string, int> now;
      for (const MapStatus& map : status.maps) now[map.name] = map.state;
      return now == states;
    });
  }

  MapStatus map(const std::string& name) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const MapStatus& map : status_->maps) {
      if (map.name == name) return map;
    }
    return {};
  }

  MergeStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return *status_;
  }

  std::size_t landmarks() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return world_ ? world_->landmarks.size() : 0;
  }

  bool comesToShowLandmarks(std::size_t count) {
    return waitFor([&] { return landmarks() == count; });
  }

  bool draws(const std::string& name) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::any_of(markers_.markers.begin(), markers_.markers.end(),
                       [&](const visualization_msgs::Marker& marker) { return marker.ns == name; });
  }

  std::string diagnosis() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return diagnosis_;
  }

  /// world -> NAME/map.
  std::optional<Pose> transform(const std::string& name) const {
    try {
      return fromMessage(buffer_.lookupTransform("world", name + "/map", ros::Time(0)).transform);
    } catch (const tf2::TransformException&) {
      return std::nullopt;
    }
  }

 private:
  void takeStatus(const MergeStatusConstPtr& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = *message;
  }
  void takeMap(const SemanticMapConstPtr& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    world_ = *message;
  }
  void takeMarkers(const visualization_msgs::MarkerArrayConstPtr& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    markers_ = *message;
  }
  void takeDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& status : message->status) {
      if (status.name.find(name_) != std::string::npos) diagnosis_ = status.message;
    }
  }

  std::string name_;
  ros::NodeHandle handle_;
  mutable std::mutex mutex_;
  std::optional<MergeStatus> status_;
  std::optional<SemanticMap> world_;
  visualization_msgs::MarkerArray markers_;
  std::string diagnosis_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener transforms_;
  ros::Subscriber status_subscriber_;
  ros::Subscriber map_subscriber_;
  ros::Subscriber markers_subscriber_;
  ros::Subscriber diagnostics_subscriber_;
  std::unique_ptr<RosProcess> process_;
};

}  // namespace semantic_mht_slam
