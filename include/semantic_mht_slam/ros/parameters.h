#pragma once

#include <vector>

#include <ros/node_handle.h>

#include "semantic_mht_slam/common/config.h"

namespace semantic_mht_slam {

/// The private parameters of a node as settings: nested maps become dotted keys. Throws InputError naming the parameter
/// for values that are no scalars.
std::vector<Setting> readParameters(const ros::NodeHandle& private_handle);

}  // namespace semantic_mht_slam
