#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <ros/ros.h>
#include <ros/service.h>

#include "semantic_mht_slam/ros/service_call.h"

namespace semantic_mht_slam {

/// Calls services, one at a time, in a thread of its own, so that no service that thinks long holds up the display. The
/// caller asks for the answer now and then. A call that is still under way when this goes is left to itself.
class ServiceCaller {
 public:
  /// Does nothing while another call is under way.
  template <class Service>
  void call(const std::string& name, const typename Service::Request& request) {
    if (!begin(name)) return;
    std::thread([state = state_, name, request]() mutable {
      Service call;
      call.request = request;
      if (!ros::service::exists(name, false)) return end(*state, name + ": no node offers this service");
      if (!callService(name, call)) return end(*state, name + ": the call failed");
      end(*state, name + (call.response.success ? ": " : " refused: ") + call.response.message);
    }).detach();
  }

  bool isBusy() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->is_busy;
  }

  /// What the status line should say: the answer, or what is waited for.
  std::string status() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->status;
  }

 private:
  struct State {
    std::mutex mutex;
    bool is_busy = false;
    std::string status;
  };

  bool begin(const std::string& name) {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    if (state_->is_busy) return false;
    state_->is_busy = true;
    state_->status = name + ": waiting for the answer";
    return true;
  }

  static void end(State& state, const std::string& status) {
    const std::lock_guard<std::mutex> lock(state.mutex);
    state.is_busy = false;
    state.status = status;
  }

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace semantic_mht_slam
