#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/landmark_files.h"
#include "semantic_mht_slam/common/stamped_pose.h"

namespace semantic_mht_slam {

/// Writes trajectory.tum, trajectory.txt, landmarks.csv and landmarks.geojson (see srv/SaveResults.srv) to a folder,
/// all or none: one that there is not, that is empty, or that holds all of these files. Throws InputError, and leaves
/// everything as it was, if it holds something else without them, which is somebody's, or cannot be written to.
void saveResults(const std::string& folder, const std::vector<StampedPose>& T_map_base,
                 const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes,
                 const std::optional<MapOrigin>& origin);

}  // namespace semantic_mht_slam
