#include "semantic_mht_slam/mapping/mapper.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "semantic_mht_slam/mapping/fusion.h"

namespace semantic_mht_slam {
namespace {

constexpr double kCertainExistence = 0.95;  // of landmarks that tell how often what exists is detected
constexpr double kCertainClass = 0.99;      // of landmarks that tell what a class is taken for
constexpr double kKeyframeSpacing_m = 2.0;  // nearer ones see the same error of a centroid

/// Deviations along a ray, across it in the plane and vertically.
Eigen::Vector3d alongRay(const Eigen::Matrix3d& cov_m2, const Eigen::Vector3d& ray_m) {
  const double planar_m = ray_m.head<2>().norm();
  const Eigen::Vector3d along = planar_m > 0.0 ? ray_m.normalized() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d across =
      planar_m > 0.0 ? Eigen::Vector3d(-ray_m.y() / planar_m, ray_m.x() / planar_m, 0.0) : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d up = along.cross(across);
  return {std::sqrt(along.dot(cov_m2 * along)), std::sqrt(across.dot(cov_m2 * across)), std::sqrt(up.dot(cov_m2 * up))};
}

}  // namespace

Mapper::Mapper(const MapperConfig& config, const ClassTable& classes)
    : config_(config),
      classes_(classes),
      calibration_(config.calibration, classes),
      bias_(config.bias, classes),
      tree_(config, classes),
      propagation_(config) {}

Eigen::Matrix3d Mapper::detectorCov(const Detection& detection) const {
  if (detection.cov_m2) return *detection.cov_m2;
  const double range_m = detection.position_m.head<2>().norm();
  const Eigen::Vector3d variance_m2 = calibration_.noiseStddev(detection.class_index, range_m).cwiseAbs2();
  Eigen::Matrix3d cov = Eigen::Vector3d(variance_m2[1], variance_m2[1], variance_m2[2]).asDiagonal();
  if (range_m > 0.0) {
    const Eigen::Vector2d ray = detection.position_m.head<2>() / range_m;
    cov.topLeftCorner<2, 2>() += (variance_m2[0] - variance_m2[1]) * ray * ray.transpose();
  }
  return cov;
}

Measurement Mapper::makeMeasurement(const Detection& detection) {
  Measurement measurement;
  measurement.position_m = bias_.corrected(detection).position_m;
  measurement.cov_m2 = detectorCov(detection) + bias_.uncertainty(detection.class_index, detection.position_m);
  measurement.ray_m = measurement.position_m;
  measurement.noise_stddev_m = alongRay(measurement.cov_m2, measurement.ray_m);
  const AssociationConfig& association = config_.association;
  const double stddev_m = std::max(association.outlier_min_stddev_m,
                                   association.outlier_factor * std::sqrt(measurement.cov_m2.diagonal().maxCoeff()));
  measurement.outlier_variance_m2 = Eigen::Vector3d::Constant(stddev_m * stddev_m);
  measurement.wander_variance_per_m = calibration_.wanderVariancePerMetre(detection.class_index);
  measurement.class_index = detection.class_index;
  measurement.row = detection.row;
  if (!detection.cov_m2 && config_.semantics) {
    measurement.noise_of_class = noiseOfClasses(detection.position_m.head<2>().norm());
  }
  return measurement;
}

std::shared_ptr<const std::vector<ClassNoise>> Mapper::noiseOfClasses(double range_m) {
  auto& known = noise_of_class_[static_cast<std::size_t>(DetectorCalibration::rangeBin(range_m))];
  if (known) return known;
  const AssociationConfig& association = config_.association;
  auto noise = std::make_shared<std::vector<ClassNoise>>();
  for (ClassIndex i = 0; i < classes_.size(); ++i) {
    const Eigen::Vector3d stddev_m = calibration_.noiseStddev(i, range_m);
    const double outlier_m =
        std::max(association.outlier_min_stddev_m, association.outlier_factor * stddev_m.maxCoeff());
    noise->push_back({stddev_m, outlier_m * outlier_m, calibration_.wanderVariancePerMetre(i)});
  }
  known = noise;
  return known;
}

bool Mapper::learnsConfusion() const {
  return config_.semantics && config_.association.learn_confusion &&
         config_.association.class_model == ClassModel::kConfusion;
}

void Mapper::learnConfusion(const std::vector<FusedAssociations>& associations,
                            const std::vector<MixtureLandmark>& landmarks) {
  std::map<LandmarkId, ClassIndex> certain;
  for (const MixtureLandmark& landmark : landmarks) {
    const bool is_certain = landmark.existence_prob >= kCertainExistence &&
                            landmark.class_probs.maxCoeff() >= kCertainClass && landmark.last_submap == index_;
    if (is_certain) certain[landmark.id] = landmark.mostLikelyClass();
  }
  for (const Keyframe& keyframe : keyframes_) {
    const std::vector<LandmarkId>& ids = associations.at(keyframe.place).landmark_of_measurement;
    for (std::size_t i = 0; i < keyframe.detections.size(); ++i) {
      const auto found = certain.find(ids[i]);
      if (found != certain.end()) tree_.confusion().add(found->second, keyframe.detections[i].class_index);
    }
  }
}

std::optional<Submap> Mapper::add(std::size_t frame, Stamp stamp, const Pose& T_odom_base, const Detections& detections,
                                  Rng& rng) {
  std::optional<Submap> finished;
  double step_m = 0.0;
  if (is_open_) {
    step_m = (T_odom_base.translation_m - T_odom_last_.translation_m).norm();
    length_m_ += step_m;
    if (length_m_ >= config_.submap.length_m) finished = finish();
  }
  if (!is_open_) begin(stamp, T_odom_base);
  T_odom_last_ = T_odom_base;
  end_ = stamp;
  TreeInput input;
  input.frame = frame;
  input.submap = index_;
  input.driven_m = length_m_;
  input.step_m = step_m;
  input.T_submap_base = T_odom_submap_.inverse() * T_odom_base;
  calibration_.add(T_odom_base, detections);
  noise_of_class_ = {};
  T_submap_base_.push_back(input.T_submap_base);
  rows_.emplace_back();
  for (const Detection& detection : detections) {
    input.measurements.push_back(makeMeasurement(detection));
    input.measurements.back().id_if_new = next_landmark_++;
    rows_.back().push_back(detection.row);
  }
  keepKeyframe(input.T_submap_base, detections);
  tree_.step(input, rng);
  return finished;
}

void Mapper::forgetSurroundings() {
  if (is_open_) throw std::logic_error("Mapper: surroundings are forgotten between submaps");
  propagation_.clear();
  calibration_.forgetFrames();
}

void Mapper::begin(Stamp stamp, const Pose& T_odom_base) {
  ++index_;
  is_open_ = true;
  begin_ = stamp;
  length_m_ = 0.0;
  T_submap_base_.clear();
  rows_.clear();
  keyframes_.clear();
  T_odom_submap_ = T_odom_base;
  const bool is_asked = config_.alignment.enabled && earlier_map_provider_;
  tree_.restart(propagation_.beginSubmap(index_, T_odom_submap_),
                is_asked ? earlier_map_provider_(T_odom_submap_) : EarlierMap{});
}

void Mapper::keepKeyframe(const Pose& T_submap_base, const Detections& detections) {
  if (!config_.bias.enabled && !learnsConfusion()) return;
  const bool is_far =
      keyframes_.empty() ||
      (T_submap_base.translation_m - keyframes_.back().T_submap_base.translation_m).norm() >= kKeyframeSpacing_m;
  if (is_far) keyframes_.push_back({rows_.size() - 1, T_submap_base, detections});
}

void Mapper::learnDetectionRate(const std::vector<FusedAssociations>& associations,
                                const std::vector<MixtureLandmark>& landmarks) {
  std::set<std::pair<LandmarkId, std::size_t>> seen;
  for (std::size_t k = 0; k < associations.size(); ++k) {
    for (const LandmarkId id : associations[k].landmark_of_measurement) seen.emplace(id, k);
  }
  for (const MixtureLandmark& landmark : landmarks) {
    if (landmark.existence_prob < kCertainExistence || landmark.last_submap != index_) continue;
    const ClassIndex class_index = landmark.mostLikelyClass();
    for (std::size_t k = 0; k < T_submap_base_.size(); ++k) {
      const Pose& T = T_submap_base_[k];
      const Eigen::Vector3d position_m = T.rotation.conjugate() * (landmark.position.mean_m - T.translation_m);
      tree_.detectionRate().add(class_index, position_m, seen.count({landmark.id, k}) > 0);
    }
  }
}

BiasStretch Mapper::biasStretch(const std::vector<FusedAssociations>& associations) const {
  BiasStretch stretch;
  for (const Keyframe& keyframe : keyframes_) {
    const int index = static_cast<int>(stretch.T_stretch_base.size());
    stretch.T_stretch_base.push_back(keyframe.T_submap_base);
    const std::vector<LandmarkId>& landmarks = associations.at(keyframe.place).landmark_of_measurement;
    for (std::size_t i = 0; i < keyframe.detections.size(); ++i) {
      if (landmarks[i] == kNoLandmark) continue;
      const Detection& detection = keyframe.detections[i];
      Eigen::Matrix3d cov = detectorCov(detection);
      cov.diagonal().head<2>().array() +=
          kKeyframeSpacing_m * calibration_.wanderVariancePerMetre(detection.class_index);
      stretch.observations.push_back({index, detection.position_m, cov, detection.class_index, landmarks[i]});
    }
  }
  return stretch;
}

void Mapper::joinEarlierMap(std::vector<MixtureLandmark>& landmarks, Submap& submap) const {
  const std::optional<MapConclusion> conclusion = tree_.mapBranching().conclude(tree_.leaves());
  if (!conclusion) return;
  submap.alignment = conclusion->alignment;
  for (const auto& [id, survivor] : conclusion->merged) {
    joinEarlierLandmark(tree_.mapBranching().landmark(survivor), id, landmarks, submap.merged);
  }
  std::sort(landmarks.begin(), landmarks.end(),
            [](const MixtureLandmark& a, const MixtureLandmark& b) { return a.id < b.id; });
}

std::optional<Submap> Mapper::finish() {
  if (!is_open_) return std::nullopt;
  is_open_ = false;
  Submap submap;
  submap.index = index_;
  submap.begin = begin_;
  submap.end = end_;
  submap.T_odom_submap = T_odom_submap_;
  const auto fused_associations = fuseAssociations(tree_.leaves());
  for (std::size_t k = 0; k < fused_associations.size(); ++k) {
    const auto& [frame, landmark_of_measurement] = fused_associations[k];
    for (std::size_t i = 0; i < landmark_of_measurement.size(); ++i) {
      submap.associations.push_back({frame, rows_[k][i], landmark_of_measurement[i]});
    }
  }
  if (config_.bias.enabled) {
    bias_.add(biasStretch(fused_associations), config_.submap.odometry_stddev_m, config_.submap.odometry_stddev_rad);
  }
  std::vector<MixtureLandmark> landmarks = fuseHypotheses(tree_.leaves());
  const auto detector_cov = [this](ClassIndex class_index) -> Eigen::Matrix3d {
    const Eigen::Vector3d stddev_m = calibration_.noiseStddev(class_index, 20.0);
    const double horizontal_m = std::max(stddev_m[0], stddev_m[1]);
    return Eigen::Vector3d(horizontal_m, horizontal_m, stddev_m[2]).cwiseAbs2().asDiagonal();
  };
  learnDetectionRate(fused_associations, landmarks);
  if (learnsConfusion()) learnConfusion(fused_associations, landmarks);
  submap.merged = mergeDuplicates(config_.duplicates, fused_associations, detector_cov, landmarks);
  joinEarlierMap(landmarks, submap);
  for (const MixtureLandmark& landmark : landmarks) {
    if (landmark.last_submap == index_) submap.landmarks.push_back(landmark);
  }
  propagation_.endSubmap(index_, T_odom_submap_, landmarks, tree_.leaves().front());
  return submap;
}

}  // namespace semantic_mht_slam
