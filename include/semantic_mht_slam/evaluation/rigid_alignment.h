#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// T_target_source that brings `source_m` onto `target_m` with the least sum of squared distances; no scale
/// (Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI 1991).
/// Points that leave the rotation open (one point, points on a line) give one of the best transforms.
/// Throws std::invalid_argument for empty lists, lists of different lengths and values that are not finite.
Pose rigidAlignment(const std::vector<Eigen::Vector3d>& source_m, const std::vector<Eigen::Vector3d>& target_m);

/// The same with a rotation about z only: the best yaw and shift in the plane, and the mean difference in z.
Pose planarAlignment(const std::vector<Eigen::Vector3d>& source_m, const std::vector<Eigen::Vector3d>& target_m);

}  // namespace semantic_mht_slam
