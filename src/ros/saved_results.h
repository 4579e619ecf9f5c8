#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/landmark_files.h"
#include "semantic_mht_slam/common/stamped_pose.h"

namespace semantic_mht_slam {

/// Writes trajectory.tum, trajectory.txt, landmarks.csv and landmarks.geojson (see srv/SaveResults.srv) to a folder,
/// all or none. Throws InputError, and leaves everything as it was, if it cannot be written or has one of these files
/// but not all: then that one is somebody's.
void saveResults(const std::string& folder, const std::vector<StampedPose>& T_map_base,
                 const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes,
                 const std::optional<MapOrigin>& origin);

}  // namespace semantic_mht_slam
