#pragma once

#include <string>

#include <ros/ros.h>

namespace semantic_mht_slam {

/// Calls a service that a node offers, and returns if it answered. The connection is closed from here, once the answer
/// is read: where the server closes it, as after ros::service::call, roscpp may see that before it has read the answer,
/// and takes the call for lost (https://github.com/ros/ros_comm/issues/1976).
/// @param name as ros::names::resolve takes it
template <class Service>
bool callService(const std::string& name, Service& call) {
  constexpr bool kPersistent = true;
  return ros::NodeHandle().serviceClient<Service>(name, kPersistent).call(call);
}

}  // namespace semantic_mht_slam
