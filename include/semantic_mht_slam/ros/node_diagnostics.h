#pragma once

#include <deque>
#include <functional>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include "semantic_mht_slam/ros/node_status.h"

namespace semantic_mht_slam {

/// Publishes the node's status on /diagnostics once a second of wall time. What was dropped in the last 10 s counts as
/// going on, so that a slow topic's fault does not flicker.
class NodeDiagnostics {
 public:
  /// `status` is called in a spinner thread and must not block.
  NodeDiagnostics(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                  std::function<NodeStatus()> status);

 private:
  using Diagnose = void (*)(const NodeStatus&, const NodeStatus&, diagnostic_updater::DiagnosticStatusWrapper&);

  void add(const std::string& name, Diagnose diagnose);
  void update(const ros::WallTimerEvent& event);

  std::function<NodeStatus()> status_;
  std::deque<NodeStatus> history_;  ///< oldest first; the newest is the current one
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace semantic_mht_slam
