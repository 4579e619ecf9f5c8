#pragma once

#include <optional>

#include <sensor_msgs/NavSatFix.h>

#include "semantic_mht_slam/app/refused_input.h"
#include "semantic_mht_slam/bags/sensor_transforms.h"
#include "semantic_mht_slam/models/gnss_fix.h"

namespace semantic_mht_slam {

/// A message as the estimator takes it, for the node and for bags alike: empty if its stamp is none. The antenna is
/// where tf has the frame of the message now; where tf does not say it, the parameters do. What is refused is counted.
std::optional<GnssFix> toFix(const sensor_msgs::NavSatFix& message, SensorTransforms& sensors, const NodeConfig& frames,
                             RefusedInput& refused);

}  // namespace semantic_mht_slam
