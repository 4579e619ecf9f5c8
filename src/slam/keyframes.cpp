#include "semantic_mht_slam/slam/keyframes.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

/// Sums of a weighted mean.
struct WeightedSum {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  int count = 0;
  const MixtureLandmark* landmark = nullptr;
};

/// The landmarks of a submap that are likely to exist, and which detections are theirs.
class KeptLandmarks {
 public:
  KeptLandmarks(const Submap& submap, double keep_prob) {
    for (const DetectionAssociation& association : submap.associations) {
      const MixtureLandmark* landmark = findLandmark(association.landmark, submap.landmarks);
      if (landmark == nullptr || landmark->existence_prob < keep_prob) continue;
      of_detection_.push_back({{association.frame, association.row}, landmark});
    }
  }

  /// The landmark that a detection belongs to; null for none.
  const MixtureLandmark* of(std::size_t frame, int row) const {
    const std::pair<std::size_t, int> detection(frame, row);
    const auto found = std::lower_bound(of_detection_.begin(), of_detection_.end(), detection,
                                        [](const auto& known, const auto& wanted) { return known.first < wanted; });
    return found == of_detection_.end() || found->first != detection ? nullptr : found->second;
  }

 private:
  std::vector<std::pair<std::pair<std::size_t, int>, const MixtureLandmark*>> of_detection_;  ///< by frame and row
};

/// Collects what one keyframe sees.
class SightingCollector {
 public:
  SightingCollector(const Pose& T_odom_keyframe, const Pose& T_odom_submap, const OdometryModel& odometry,
                    const KeyframeConfig& config)
      : T_keyframe_odom_(T_odom_keyframe.inverse()),
        T_keyframe_submap_(T_keyframe_odom_ * T_odom_submap),
        odometry_(odometry),
        config_(config) {}

  /// Goes on to a frame, where `motion` from the keyframe has led.
  void moveTo(const Pose& T_odom_base, const Motion& motion) {
    T_keyframe_base_ = expectedStep(odometry_, T_keyframe_odom_ * T_odom_base);
    R_keyframe_base_ = T_keyframe_base_.rotation.toRotationMatrix();
    variance_ = varianceOf(odometry_, motion);
  }

  void add(const MixtureLandmark& landmark, const Detection& detection) {
    const Eigen::Matrix3d& R = R_keyframe_base_;
    const Eigen::Matrix3d cov = R * detection.cov_m2.value() * R.transpose() + driftAt(R * detection.position_m);
    const Eigen::Matrix3d information = cov.inverse();
    WeightedSum& sum = sums_[landmark.id];
    sum.landmark = &landmark;
    sum.information += information;
    sum.weighted += information * (T_keyframe_base_ * detection.position_m);
    ++sum.count;
  }

  void writeTo(CutSubmap& cut) const {
    const Eigen::Matrix3d floor =
        Eigen::Vector3d(config_.sighting_floor_m, config_.sighting_floor_m, config_.vertical_floor_m)
            .cwiseAbs2()
            .asDiagonal();
    for (const auto& [id, sum] : sums_) {
      const Eigen::Matrix3d cov = sum.information.inverse();
      const ClassIndex class_index = sum.landmark->mostLikelyClass();
      cut.sightings.back().push_back(
          {id, class_index, cov * sum.weighted, 0.5 * (cov + cov.transpose()) + floor, sum.count});
      cut.keyframes.back().scene.objects.push_back(
          sceneObject(*sum.landmark, T_keyframe_submap_, config_.sighting_floor_m));
    }
  }

 private:
  /// Covariance of what the odometry is off by at a place `lever_m` from the base, keyframe's axes.
  Eigen::Matrix3d driftAt(const Eigen::Vector3d& lever_m) const {
    const double planar_m2 = std::max(variance_.along_m2, variance_.across_m2);
    Eigen::Matrix3d cov = Eigen::Vector3d(planar_m2, planar_m2, variance_.up_m2).asDiagonal();
    const Eigen::Vector3d reach_m = lever_m + 0.5 * T_keyframe_base_.translation_m;
    const Eigen::Vector3d turned(-reach_m.y(), reach_m.x(), 0.0);
    cov += variance_.heading_rad2 * turned * turned.transpose();
    cov(2, 2) += variance_.tilt_rad2 * reach_m.head<2>().squaredNorm();
    return cov;
  }

  Pose T_keyframe_odom_;
  Pose T_keyframe_submap_;
  const OdometryModel& odometry_;
  const KeyframeConfig& config_;
  Pose T_keyframe_base_;
  Eigen::Matrix3d R_keyframe_base_;
  MotionVariance variance_;
  std::map<LandmarkId, WeightedSum> sums_;
};

}  // namespace

void describe(KeyframeConfig& config, Fields& fields) {
  fields.add("spacing", config.spacing_m, "m", {0.1, 1000.0}, "Travelled distance between keyframes.");
  fields.add("sighting_floor", config.sighting_floor_m, "m", {0.001, 10.0},
             "Deviation of a landmark's position in a keyframe that more detections do not lower.");
  fields.add("vertical_floor", config.vertical_floor_m, "m", {0.001, 100.0},
             "The same for its height: of trunks and poles a sensor sees another part from each distance.");
}

CutSubmap cutIntoKeyframes(const Submap& submap, const std::vector<Frame>& frames, Motion driven, double keep_prob,
                           const OdometryModel& odometry, const KeyframeConfig& config) {
  const KeptLandmarks landmarks(submap, keep_prob);
  CutSubmap cut;
  std::optional<SightingCollector> collector;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    if (i > 0) driven = driven + motionOf(frames[i - 1].T_odom_base.inverse() * frame.T_odom_base);
    if (cut.keyframes.empty() || driven.way_m - cut.keyframes.back().driven_m >= config.spacing_m) {
      if (collector) collector->writeTo(cut);
      cut.keyframes.push_back(
          {frame.index, submap.id, driven.way_m, {}, frame.stamp, frame.T_odom_base, driven.turn_rad});
      cut.sightings.emplace_back();
      collector.emplace(frame.T_odom_base, submap.T_odom_submap, odometry, config);
    }
    collector->moveTo(frame.T_odom_base, driven - motionTo(cut.keyframes.back()));
    for (const Detection& detection : frame.detections) {
      const MixtureLandmark* landmark = landmarks.of(frame.index, detection.row);
      if (landmark != nullptr) collector->add(*landmark, detection);
    }
  }
  if (collector) collector->writeTo(cut);
  return cut;
}

}  // namespace semantic_mht_slam
