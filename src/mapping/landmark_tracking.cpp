#include "semantic_mht_slam/mapping/landmark_tracking.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/log_math.h"
#include "semantic_mht_slam/mapping/existence.h"
#include "semantic_mht_slam/models/landmark_filter.h"

namespace semantic_mht_slam {
namespace {

constexpr double kLowDetectionProb = 0.01;     // below this nothing is expected
constexpr double kMinRange_m = 0.5;            // nearer detections have no direction
constexpr double kMaxLogExistenceOdds = 20.0;  // what hundreds of frames behind a house cannot take away

}  // namespace

LandmarkTracking::LandmarkTracking(const MapperConfig& config, const ClassTable& classes)
    : config_(config), rate_(config.detection, classes.size()) {}

std::optional<FilterUpdate> LandmarkTracking::filtered(const Gaussian3& predicted, const Measurement& measurement,
                                                       bool is_outlier) const {
  const double range_m = measurement.ray_m.norm();
  if (config_.measurement_model == MeasurementModel::kAdditive || range_m < kMinRange_m) {
    PositionMeasurement position{measurement.position_m, measurement.cov_m2};
    if (is_outlier) position.cov_m2.diagonal() += measurement.outlier_variance_m2;
    return unscentedUpdate(predicted, position);
  }
  const Eigen::Vector3d outlier_m2 = is_outlier ? measurement.outlier_variance_m2 : Eigen::Vector3d::Zero();
  const Eigen::Vector3d stddev_m = (measurement.noise_stddev_m.cwiseAbs2() + outlier_m2).cwiseSqrt();
  RangeBearingMeasurement polar;
  // The pose that makes the ray end where the measurement is, whatever corrected it.
  polar.T_landmarks_sensor.rotation = measurement.R_submap_base;
  polar.T_landmarks_sensor.translation_m = measurement.position_m - measurement.R_submap_base * measurement.ray_m;
  polar.range_bearing_elevation = toRangeBearingElevation(measurement.ray_m);
  const double planar_m = std::max(kMinRange_m, measurement.ray_m.head<2>().norm());
  polar.stddev = {stddev_m[0], stddev_m[1] / planar_m, stddev_m[2] / range_m};
  polar.sensor_position_cov_m2 = measurement.pose_cov_m2;
  return unscentedUpdate(predicted, polar);
}

TrackedLandmarkPtr LandmarkTracking::updated(const AssociationModel& model, const TrackedLandmark& landmark,
                                             const Measurement& detected, const TreeInput& input,
                                             const Candidate& candidate) const {
  const Measurement measurement = ofObject(detected, landmark.mostLikelyClass());
  auto result = std::make_shared<TrackedLandmark>(landmark);
  Gaussian3 predicted = landmark.position;
  predicted.cov_m2.diagonal().head<2>().array() +=
      measurement.wander_variance_per_m * (input.driven_m - landmark.updated_at_m);
  result->updated_at_m = input.driven_m;
  const auto update = filtered(predicted, measurement, candidate.is_outlier);
  if (update) result->position = update->posterior;
  result->class_probs = model.updatedClassProbs(landmark.class_probs, measurement.class_index);
  ++result->observations;
  if (landmark.is_expected) {
    result->id = measurement.id_if_new;  // as in the branches that know nothing of the earlier map
    result->observations = 1;
    result->first_submap = input.submap;
    result->is_expected = false;
  }
  result->is_from_earlier_submap = false;
  result->last_submap = input.submap;
  // A detection where the landmark is speaks for it against clutter, which would be anywhere in the volume.
  applyHit(*result, detectionProb(landmark, input), config_.detection.visibility_switch_prob,
           candidate.log_likelihood - model.logClutterDensity(), kMaxLogExistenceOdds);
  return result;
}

TrackedLandmarkPtr LandmarkTracking::begun(const AssociationModel& model, const Measurement& measurement,
                                           const TreeInput& input) const {
  auto landmark = std::make_shared<TrackedLandmark>();
  landmark->id = measurement.id_if_new;
  landmark->position = {measurement.position_m, measurement.cov_m2};
  landmark->class_probs = model.initialClassProbs(measurement.class_index);
  landmark->log_existence_odds = logit(config_.detection.birth_prob);
  landmark->observations = 1;
  landmark->first_submap = input.submap;
  landmark->last_submap = input.submap;
  landmark->updated_at_m = input.driven_m;
  return landmark;
}

double LandmarkTracking::detectionProb(const TrackedLandmark& landmark, const TreeInput& input) const {
  const Eigen::Vector3d position_m =
      input.T_submap_base.rotation.conjugate() * (landmark.position.mean_m - input.T_submap_base.translation_m);
  return std::max(kLowDetectionProb, rate_.prob(landmark.mostLikelyClass(), position_m));
}

double LandmarkTracking::applyMissedDetections(MapHypothesis& hypothesis, const TreeInput& input,
                                               const std::vector<char>& is_seen) const {
  if (!config_.detection.missed_detections) return 0.0;
  const double switch_prob = config_.detection.visibility_switch_prob;
  const double forget_log_odds = logit(config_.detection.forget_prob);
  double log_weight = 0.0;
  std::size_t kept = 0;
  for (std::size_t j = 0; j < hypothesis.landmarks.size(); ++j) {
    TrackedLandmarkPtr landmark = std::move(hypothesis.landmarks[j]);
    const double detection_prob = detectionProb(*landmark, input);
    if (is_seen[j] != 0) {
      log_weight += std::log(detection_prob);
    } else if (detection_prob > kLowDetectionProb) {
      auto missed = std::make_shared<TrackedLandmark>(*landmark);
      const double likelihood = applyMiss(*missed, detection_prob, switch_prob);
      const double existence = logistic(landmark->log_existence_odds);
      if (landmark->is_expected) {
        hypothesis.expected_missed += landmark->miss_likelihood * (1.0 - likelihood);
        missed->miss_likelihood *= likelihood;
      } else {
        log_weight += std::log1p(-existence * (1.0 - likelihood));
      }
      landmark = std::move(missed);
      if (landmark->log_existence_odds < forget_log_odds) continue;
    }
    hypothesis.landmarks[kept++] = std::move(landmark);
  }
  hypothesis.landmarks.resize(kept);
  return log_weight;
}

}  // namespace semantic_mht_slam
