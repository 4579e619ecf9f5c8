#include "semantic_mht_slam/mapping/landmark_tracking.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/log_math.h"
#include "semantic_mht_slam/mapping/existence.h"
#include "semantic_mht_slam/models/landmark_filter.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMinRange_m = 0.5;            // nearer detections have no direction
constexpr double kMaxLogExistenceOdds = 20.0;  // what hundreds of frames behind a house cannot take away

}  // namespace

LandmarkTracking::LandmarkTracking(const MapperConfig& config, const ClassTable& classes)
    : config_(config), log_forget_odds_(logit(config.detection.forget_prob)), rate_(config.detection, classes.size()) {}

std::optional<FilterUpdate> LandmarkTracking::filtered(const Gaussian3& predicted, const Measurement& measurement,
                                                       bool is_outlier) const {
  const double range_m = measurement.ray_m.norm();
  if (config_.measurement_model == MeasurementModel::kAdditive || range_m < kMinRange_m) {
    PositionMeasurement position{measurement.position_m, measurement.cov_m2};
    if (is_outlier) position.cov_m2 += measurement.outlier_cov_m2;
    return unscentedUpdate(predicted, position);
  }
  Eigen::Vector3d variance_m2 = measurement.noise_stddev_m.cwiseAbs2();
  if (is_outlier) {
    const Eigen::Matrix3d axes = rayAxes(measurement);
    variance_m2 += (axes.transpose() * measurement.outlier_cov_m2 * axes).diagonal();
  }
  const Eigen::Vector3d stddev_m = variance_m2.cwiseSqrt();
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

HypothesisLandmark LandmarkTracking::updated(const AssociationModel& model, const HypothesisLandmark& known,
                                             const Measurement& detected, const TreeInput& input,
                                             const Candidate& candidate, double detection_prob) const {
  const TrackedLandmark& landmark = *known;
  Measurement of_class;
  const Measurement& measurement = ofObject(detected, landmark.mostLikelyClass(), of_class);
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
  // A detection where the landmark is speaks for it against clutter, which would be anywhere.
  Existence existence = known.existence;
  applyHit(existence, detection_prob, config_.detection.visibility_switch_prob,
           candidate.log_likelihood - model.logClutterDensity(detected), kMaxLogExistenceOdds);
  return {std::move(result), existence};
}

HypothesisLandmark LandmarkTracking::begun(const AssociationModel& model, const Measurement& measurement,
                                           const TreeInput& input) const {
  auto landmark = std::make_shared<TrackedLandmark>();
  landmark->id = measurement.id_if_new;
  landmark->position = {measurement.position_m, measurement.cov_m2};
  landmark->class_probs = model.initialClassProbs(measurement.class_index);
  landmark->observations = 1;
  landmark->first_submap = input.submap;
  landmark->last_submap = input.submap;
  landmark->updated_at_m = input.driven_m;
  Existence existence;
  existence.log_odds = logit(model.birthProb(measurement));
  return {std::move(landmark), existence};
}

void LandmarkTracking::miss(const HypothesisLandmark& landmark, LandmarkOutlook& outlook) const {
  const double likelihood = applyMiss(outlook.missed, outlook.detection_prob, config_.detection.visibility_switch_prob);
  if (landmark->is_expected) {
    outlook.expected_missed = outlook.missed.miss_likelihood * (1.0 - likelihood);
    outlook.missed.miss_likelihood *= likelihood;
  } else {
    outlook.log_missed = std::log1p(-logistic(landmark.existence.log_odds) * (1.0 - likelihood));
  }
  outlook.is_forgotten = outlook.missed.log_odds < log_forget_odds_;
}

void LandmarkTracking::lookOut(const MapHypothesis& hypothesis, const TreeInput& input,
                               std::vector<LandmarkOutlook>& outlooks) const {
  const Eigen::Matrix3d R_base_submap = input.T_submap_base.rotation.conjugate().toRotationMatrix();
  const double max_range_m = config_.detection.max_range_m;
  outlooks.resize(hypothesis.landmarks.size());
  for (std::size_t j = 0; j < outlooks.size(); ++j) {
    const HypothesisLandmark& landmark = hypothesis.landmarks[j];
    LandmarkOutlook& outlook = outlooks[j];
    outlook = {kLowDetectionProb, 0.0, 0.0, landmark.existence, false};
    const Eigen::Vector3d lever_m = landmark->position.mean_m - input.T_submap_base.translation_m;
    const Eigen::Vector3d position_m = R_base_submap * lever_m;
    if (position_m.head<2>().squaredNorm() > max_range_m * max_range_m) continue;
    outlook.detection_prob = std::max(kLowDetectionProb, rate_.prob(landmark->mostLikelyClass(), position_m));
    if (config_.detection.missed_detections && outlook.detection_prob > kLowDetectionProb) miss(landmark, outlook);
  }
}

}  // namespace semantic_mht_slam
