#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/evaluation/landmark_error.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Number of frames that show each landmark: those with an object of it, which is the landmark that stands nearest in
/// the plane, within `radius_m`. Objects of an objects CSV, of the classes named, or of all if none is;
/// `T_truth_sensor` are the poses of its frames. Throws InputError that names file, line and column.
std::vector<int> framesThatShow(const std::vector<PointLandmark>& landmarks, const std::string& objects_path,
                                const ClassTable& table, const std::vector<std::string>& classes,
                                const std::vector<Pose>& T_truth_sensor, double radius_m);

}  // namespace semantic_mht_slam
