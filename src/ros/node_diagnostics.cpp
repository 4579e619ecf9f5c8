#include "semantic_mht_slam/ros/node_diagnostics.h"

#include <utility>

#include "semantic_mht_slam/ros/diagnosis.h"

namespace semantic_mht_slam {
namespace {

constexpr double kPeriod_s = 1.0;
constexpr std::size_t kMemory = 11;  // statuses: ten periods

}  // namespace

NodeDiagnostics::NodeDiagnostics(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                                 std::function<NodeStatus()> status)
    : status_(std::move(status)), history_(1), updater_(handle, private_handle, private_handle.getNamespace()) {
  updater_.setHardwareID(kDiagnosticsHardwareId);
  add("clock", diagnoseClock);
  add("odometry", diagnoseOdometry);
  add("objects", diagnoseObjects);
  add("queue", diagnoseQueue);
  add("estimator", diagnoseEstimator);
  timer_ = handle.createWallTimer(ros::WallDuration(kPeriod_s), &NodeDiagnostics::update, this);
}

void NodeDiagnostics::add(const std::string& name, Diagnose diagnose) {
  updater_.add(name, [this, diagnose](diagnostic_updater::DiagnosticStatusWrapper& wrapper) {
    diagnose(history_.back(), history_.front(), wrapper);
  });
}

void NodeDiagnostics::update(const ros::WallTimerEvent&) {
  history_.push_back(status_());
  if (history_.size() > kMemory) history_.pop_front();
  updater_.force_update();
}

}  // namespace semantic_mht_slam
