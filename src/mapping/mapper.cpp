#include "semantic_mht_slam/mapping/mapper.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "semantic_mht_slam/mapping/fusion.h"
#include "semantic_mht_slam/mapping/near_landmarks.h"

namespace semantic_mht_slam {
namespace {

/// Deviations along a ray, across it in the plane and vertically.
Eigen::Vector3d alongRay(const Eigen::Matrix3d& cov_m2, const Eigen::Vector3d& ray_m) {
  const double planar_m = ray_m.head<2>().norm();
  const Eigen::Vector3d along = planar_m > 0.0 ? ray_m.normalized() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d across =
      planar_m > 0.0 ? Eigen::Vector3d(-ray_m.y() / planar_m, ray_m.x() / planar_m, 0.0) : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d up = along.cross(across);
  return {std::sqrt(along.dot(cov_m2 * along)), std::sqrt(across.dot(cov_m2 * across)), std::sqrt(up.dot(cov_m2 * up))};
}

/// Of a detection, by its variances along the ray, across it and vertically.
Eigen::Matrix3d covAlongRay(const Detection& detection, const Eigen::Vector3d& variance_m2) {
  const double range_m = detection.position_m.head<2>().norm();
  Eigen::Matrix3d cov = Eigen::Vector3d(variance_m2[1], variance_m2[1], variance_m2[2]).asDiagonal();
  if (range_m > 0.0) {
    const Eigen::Vector2d ray = detection.position_m.head<2>() / range_m;
    cov.topLeftCorner<2, 2>() += (variance_m2[0] - variance_m2[1]) * ray * ray.transpose();
  }
  return cov;
}

/// How far apart parts of one object are shown, squared, in units of the covariance of both centroids: one of the two
/// may be far off.
double partsGate(const MapperConfig& config) {
  const double factor = config.association.outlier_prob > 0.0 ? config.association.outlier_factor : 1.0;
  return config.duplicates.gate_mahalanobis_sq * 0.5 * (1.0 + factor * factor);
}

bool isEarlier(const DetectionAssociation& a, const DetectionAssociation& b) {
  return std::tie(a.frame, a.row) < std::tie(b.frame, b.row);
}

/// Detections belong to the first name of their landmark.
void useFirstNames(const std::vector<SameLandmark>& duplicates, std::vector<DetectionAssociation>& associations) {
  std::map<LandmarkId, LandmarkId> first_of;
  for (auto duplicate = duplicates.rbegin(); duplicate != duplicates.rend();
       ++duplicate) {  // a first name may go later
    const auto found = first_of.find(duplicate->second);
    first_of[duplicate->first] = found == first_of.end() ? duplicate->second : found->second;
  }
  for (DetectionAssociation& association : associations) {
    const auto found = first_of.find(association.landmark);
    if (found != first_of.end()) association.landmark = found->second;
  }
}

}  // namespace

Mapper::Mapper(const MapperConfig& config, const ClassTable& classes, const RegistrationConfig& registration)
    : config_(config),
      classes_(classes),
      calibration_(config.calibration, classes),
      bias_(config.bias, classes),
      odometry_(config.odometry),
      movers_(config.moving, classes.size(), config.association.max_gate_m),
      tree_(config, classes, registration),
      propagation_(config) {}

Detections Mapper::calibrated(Detections detections) const {
  detections.erase(std::remove_if(detections.begin(), detections.end(), [](const Detection& d) { return d.is_moving; }),
                   detections.end());
  for (Detection& detection : detections) {
    detection = bias_.corrected(detection);
    detection.cov_m2 = detectorCov(detection);
  }
  return detections;
}

/// Noise of a detection's centroid as it is known now: its own, else the calibrated one. Base frame, m^2.
Eigen::Matrix3d Mapper::detectorCov(const Detection& detection) const {
  if (detection.cov_m2) return *detection.cov_m2;
  const double range_m = detection.position_m.head<2>().norm();
  return covAlongRay(detection, calibration_.noiseStddev(detection.class_index, range_m).cwiseAbs2());
}

Measurement Mapper::makeMeasurement(const Detection& detection) {
  Measurement measurement;
  const ClassNoise* noise = nullptr;
  if (!detection.cov_m2 && config_.semantics) {
    measurement.noise_of_class = noiseOfClasses(detection.position_m.head<2>().norm());
    noise = &(*measurement.noise_of_class)[static_cast<std::size_t>(detection.class_index)];
  }
  const Eigen::Matrix3d detector_cov =
      noise != nullptr ? covAlongRay(detection, noise->stddev_m.cwiseAbs2()) : detectorCov(detection);
  measurement.position_m = bias_.corrected(detection).position_m;
  measurement.cov_m2 = detector_cov + bias_.uncertainty(detection.class_index, detection.position_m);
  measurement.ray_m = measurement.position_m;
  measurement.noise_stddev_m = alongRay(measurement.cov_m2, measurement.ray_m);
  const AssociationConfig& association = config_.association;
  measurement.outlier_cov_m2 = association.outlier_factor * association.outlier_factor * measurement.cov_m2;
  measurement.outlier_cov_m2.diagonal().array() += std::pow(association.outlier_min_stddev_m, 2);
  measurement.wander_variance_per_m =
      noise != nullptr ? noise->wander_variance_per_m : calibration_.wanderVariancePerMetre(detection.class_index);
  measurement.class_index = detection.class_index;
  measurement.row = detection.row;
  return measurement;
}

std::shared_ptr<const std::vector<ClassNoise>> Mapper::noiseOfClasses(double range_m) {
  auto& known = noise_of_class_[static_cast<std::size_t>(DetectorCalibration::rangeBin(range_m))];
  if (known) return known;
  const AssociationConfig& association = config_.association;
  auto noise = std::make_shared<std::vector<ClassNoise>>();
  for (ClassIndex i = 0; i < classes_.size(); ++i) {
    const Eigen::Vector3d stddev_m = calibration_.noiseStddev(i, range_m);
    const Eigen::Array3d outlier_m2 =
        (association.outlier_factor * stddev_m).array().square() + std::pow(association.outlier_min_stddev_m, 2);
    noise->push_back({stddev_m, outlier_m2, calibration_.wanderVariancePerMetre(i)});
  }
  known = noise;
  return known;
}

void Mapper::begin(const Pose& T_odom_submap, EarlierMap earlier_map) {
  if (is_open_) throw std::logic_error("Mapper: a submap begins in another one");
  id_ = id_.isNone() ? SubmapId(0) : SubmapId(id_.index() + 1);
  is_open_ = true;
  motion_ = {};
  frames_.clear();
  spaced_.clear();
  stations_.clear();
  T_odom_submap_ = T_odom_submap;
  if (!config_.alignment.enabled) earlier_map = {};
  tree_.restart(propagation_.beginSubmap(id_, T_odom_submap_), std::move(earlier_map));
}

void Mapper::add(Frame frame, Rng& rng) {
  if (!is_open_) throw std::logic_error("Mapper: a frame between submaps");
  TreeInput input;
  motion_ = motionWith(frame.T_odom_base);
  input.frame = frame.index;
  input.submap = id_;
  input.driven_m = motion_.way_m;
  input.T_submap_last = T_submap_base(frames_.empty() ? frame : frames_.back());
  input.T_submap_base = T_submap_base(frame);
  input.odometry = odometry_.model();
  dropMoving(frame);
  calibration_.add(frame.T_odom_base, frame.detections);
  noise_of_class_ = {};
  input.measurements.reserve(frame.detections.size());
  for (const Detection& detection : frame.detections) {
    input.measurements.push_back(makeMeasurement(detection));
    input.measurements.back().id_if_new = next_landmark_++;
  }
  if (!frames_.empty()) driven_m_ += motionOf(frames_.back().T_odom_base.inverse() * frame.T_odom_base).way_m;
  trackMovable(frame, input.measurements);
  const auto is_far = [&](const Frame& other) {
    return (frame.T_odom_base.translation_m - other.T_odom_base.translation_m).norm() >= frameSpacing_m();
  };
  if (spaced_.empty() || is_far(frames_[spaced_.back()])) spaced_.push_back(frames_.size());
  stations_.add(frames_.size(), input.T_submap_base, motion_, frame.detections, stationSpacing_m());
  frames_.push_back(std::move(frame));
  tree_.step(input, rng);
}

void Mapper::goOnAfter(SubmapId newest, LandmarkId newest_landmark) {
  if (is_open_) throw std::logic_error("Mapper: submaps are renamed between submaps");
  id_ = newest;
  next_landmark_ = newest_landmark + 1;
}

void Mapper::forgetSurroundings() {
  if (is_open_) throw std::logic_error("Mapper: surroundings are forgotten between submaps");
  propagation_.clear();
  spans_.clear();
  movers_.clear();
  calibration_.forgetFrames();
}

FinishedSubmap Mapper::finish(const ExplainLimits& explained) {
  if (frames_.empty() || !is_open_) throw std::logic_error("Mapper: there is no submap to finish");
  is_open_ = false;
  FinishedSubmap finished;
  Submap& submap = finished.submap;
  submap.id = id_;
  submap.begin = frames_.front().stamp;
  submap.end = frames_.back().stamp;
  submap.T_odom_submap = T_odom_submap_;
  const auto fused_associations = fuseAssociations(tree_.leaves());
  for (std::size_t k = 0; k < fused_associations.size(); ++k) {
    const std::vector<LandmarkId>& ids = fused_associations[k].landmark_of_measurement;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      submap.associations.push_back({fused_associations[k].frame, frames_[k].detections[i].row, ids[i]});
    }
  }
  std::vector<MixtureLandmark> landmarks = fuseHypotheses(tree_.leaves());
  judgeMotion(fused_associations, landmarks);
  learn(fused_associations, landmarks);
  const std::vector<Frame> measured = std::exchange(frames_, {});  // as the detector has them
  finished.frames = measured;
  spaced_.clear();
  stations_.clear();
  for (Frame& frame : finished.frames) frame.detections = calibrated(std::move(frame.detections));
  submap.near = findNearLandmarks(finished.frames, submap.associations, partsGate(config_));
  SideBySide seen;
  seen.add(submap.associations, submap.near);
  const auto detector_cov = [this](ClassIndex class_index) -> Eigen::Matrix3d {
    const Eigen::Vector3d stddev_m = calibration_.noiseStddev(class_index, 20.0);
    const double horizontal_m = std::max(stddev_m[0], stddev_m[1]);
    return Eigen::Vector3d(horizontal_m, horizontal_m, stddev_m[2]).cwiseAbs2().asDiagonal();
  };
  submap.duplicates = mergeDuplicates(config_.duplicates, config_.association.split_prob, fused_associations, seen,
                                      detector_cov, landmarks);
  if (!submap.duplicates.empty()) {
    useFirstNames(submap.duplicates, submap.associations);
    submap.near = findNearLandmarks(finished.frames, submap.associations, partsGate(config_));
  }
  UnsureSelection unsure(explained);
  judgeAssociations(fused_associations, measured, landmarks, submap.associations, unsure);
  finished.unsure = unsure.take(id_);
  submap.associations.insert(submap.associations.end(), moving_.begin(), moving_.end());
  std::stable_sort(submap.associations.begin(), submap.associations.end(), isEarlier);
  finished.alignment = tree_.mapBranching().conclude(tree_.leaves());
  for (const MixtureLandmark& landmark : landmarks) {
    if (landmark.last_submap == id_) submap.landmarks.push_back(landmark);
  }
  tree_.neighbours().add(id_, submap.landmarks, submap.associations);
  propagation_.endSubmap(id_, T_odom_submap_, landmarks, tree_.leaves().front());
  forgetSpans();
  track_of_detection_.clear();
  moving_.clear();
  movers_.forgetEnded();
  return finished;
}

}  // namespace semantic_mht_slam
