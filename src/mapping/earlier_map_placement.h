#pragma once

#include <vector>

#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/mapping/pose_offset.h"

namespace semantic_mht_slam {

/// T_earlier_submap of a hypothesis's `map_offset`.
inline Pose poseOf(const PoseOffset& map_offset) {
  return corrected(Pose::identity(), map_offset);
}

/// Where an offset puts the earlier landmarks, submap frame.
class EarlierMapPlacement {
 public:
  EarlierMapPlacement(const std::vector<MixtureLandmark>& landmarks, const PoseOffset& offset, double noise_floor_m)
      : landmarks_(landmarks),
        offset_(offset),
        noise_floor_m2_(noise_floor_m * noise_floor_m),
        T_submap_earlier_(poseOf(offset).inverse()),
        R_(T_submap_earlier_.rotation.toRotationMatrix()) {}

  Eigen::Vector3d mean_m(int earlier) const { return R_ * position(earlier).mean_m + T_submap_earlier_.translation_m; }

  Eigen::Matrix3d cov_m2(int earlier) const {
    const Gaussian3& seen = position(earlier);
    Eigen::Matrix3d cov = seen.cov_m2 + pointCov(offset_, seen.mean_m - offset_.mean.head<3>());
    cov.diagonal().array() += noise_floor_m2_;
    return symmetric(R_ * cov * R_.transpose());
  }

  Gaussian3 operator()(int earlier) const { return {mean_m(earlier), cov_m2(earlier)}; }

 private:
  const Gaussian3& position(int earlier) const { return landmarks_[static_cast<std::size_t>(earlier)].position; }

  const std::vector<MixtureLandmark>& landmarks_;
  PoseOffset offset_;
  double noise_floor_m2_;
  Pose T_submap_earlier_;
  Eigen::Matrix3d R_;
};

}  // namespace semantic_mht_slam
