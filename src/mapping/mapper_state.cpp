#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/map_state.h"
#include "semantic_mht_slam/mapping/hypothesis_state.h"
#include "semantic_mht_slam/mapping/mapper.h"
#include "semantic_mht_slam/models/detection_state.h"

#include "bias_equations.h"

// What of the mapper outlives a program: the open submap with its hypotheses, and all that was learned on the way.
namespace semantic_mht_slam {
namespace {

/// A list that has one entry a class, or one a cell, of the present configuration.
template <class List>
void transferFixed(StateArchive& archive, List& list) {
  const std::size_t size = list.size();
  archive(list);
  if (list.size() != size) StateArchive::fail("it belongs to another class table");
}

void transferLandmarks(StateArchive& archive, std::vector<HypothesisLandmark>& landmarks) {
  std::vector<TrackedLandmark> tracked;
  std::vector<Existence> existence;
  for (const HypothesisLandmark& landmark : landmarks) {
    tracked.push_back(*landmark);
    existence.push_back(landmark.existence);
  }
  archive(tracked, existence);
  if (!archive.isReading()) return;
  if (existence.size() != tracked.size()) StateArchive::fail("landmarks without existence");
  landmarks.clear();
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    landmarks.push_back({std::make_shared<const TrackedLandmark>(std::move(tracked[i])), existence[i]});
  }
}

}  // namespace

void RunningMedian::transfer(StateArchive& archive) {
  archive(bins_, count_);
  if (archive.isReading()) {
    median_bin_ = below_ = 0;
    moveToMedian();
  }
}

void DetectorCalibration::PastFrame::transfer(StateArchive& archive) {
  archive(T_odom_base, positions_m, classes);
  if (classes.size() != positions_m.size()) StateArchive::fail("a frame with more positions than classes");
}

void DetectorCalibration::ClassStatistics::transfer(StateArchive& archive) {
  archive(noise, wander, wander_distance_m);
}

void DetectorCalibration::transfer(StateArchive& archive) {
  transferFixed(archive, statistics_);
  archive(past_);
  while (static_cast<int>(past_.size()) > config_.lag_frames) past_.pop_front();
}

void CentroidBias::transfer(StateArchive& archive) {
  std::vector<int> place = place_;
  Eigen::MatrixXd information = information_;
  Eigen::VectorXd vector = vector_;
  archive(place, information, vector);
  if (!archive.isReading()) return;
  if (place.size() != place_.size()) StateArchive::fail("it belongs to another class table");
  int biased_count = 0;
  for (const int p : place) {
    if (p != -1 && p != biased_count++) StateArchive::fail("places of biases that are not in order");
  }
  const int size = BiasLayout{biased_count}.size();
  if (vector.size() != size || information.rows() != size || information.cols() != size) {
    StateArchive::fail("a bias of another size than its classes have");
  }
  adopt(place, information, vector);
  if (!vector_.allFinite() || !solve()) StateArchive::fail("a bias without a solution");
}

void DetectionRate::Cell::transfer(StateArchive& archive) {
  archive(detected, frames);
}

void DetectionRate::transfer(StateArchive& archive) {
  transferFixed(archive, cells_);
}

void ClassConfusion::transfer(StateArchive& archive) {
  transferFixed(archive, counts_);
  for (ClassIndex object = 0; object < class_count_; ++object) evaluate(object);
}

void MapBranching::transfer(StateArchive& archive) {
  auto& [landmarks, stddev_xy_m, stddev_z_m, stddev_yaw_rad] = map_;
  archive(landmarks, stddev_xy_m, stddev_z_m, stddev_yaw_rad);
  if (archive.isReading()) restart(std::move(map_));
  archive(next_attempt_m_);
}

void MultiHypothesisTree::transfer(StateArchive& archive) {
  archive(tracking_.detectionRate(), model_.confusion(), branching_);
  transferLeaves(archive, leaves_);
  archive(next_hypothesis_id_);
}

void LandmarkPropagation::transfer(StateArchive& archive) {
  archive(T_odom_last_, last_offset_);
  transferLandmarks(archive, landmarks_);
  transferLandmarks(archive, resting_);
}

void ErrorInformation::transfer(StateArchive& archive) {
  archive(matrix, vector, design, effect);
  const Eigen::Index size = vector.size();
  if (matrix.rows() != size || matrix.cols() != size || design.rows() != size || effect.rows() != size) {
    StateArchive::fail("errors of the odometry whose sizes do not fit");
  }
}

void VarianceComponents::transfer(StateArchive& archive) {
  const Eigen::Index parts = prior_mean_.size();
  const Eigen::Index effects = effect_.size();
  archive(prior_mean_, prior_precision_, effect_information_, effect_vector_, stretches_);
  archive(log_variance_, log_uncertainty_, effect_, effect_cov_);
  bool fits = prior_mean_.size() == parts && prior_precision_.rows() == parts && prior_precision_.cols() == parts &&
              log_variance_.size() == parts && log_uncertainty_.size() == parts && log_variance_.allFinite() &&
              effect_.size() == effects && effect_vector_.size() == effects && effect_information_.rows() == effects &&
              effect_information_.cols() == effects && effect_cov_.rows() == effects && effect_cov_.cols() == effects;
  for (const ErrorInformation& stretch : stretches_) {
    fits = fits && stretch.design.cols() == parts && stretch.effect.cols() == effects;
  }
  if (!fits) StateArchive::fail("errors of the odometry in other parts");
}

void OdometryLearning::transfer(StateArchive& archive) {
  archive(planar_, vertical_);
  if (archive.isReading() && config_.learn) readOff();
}

void StationKeeping::Seen::transfer(StateArchive& archive) {
  archive(place, measurement, T_station_base, detection);
}

void StationKeeping::Station::transfer(StateArchive& archive) {
  archive(T_submap_base, motion, seen);
}

void StationKeeping::transfer(StateArchive& archive) {
  archive(stations_);
}

void Mapper::transfer(StateArchive& archive) {
  archive(calibration_, bias_, odometry_, tree_);
  archive(next_landmark_, id_, is_open_, T_odom_submap_, motion_, frames_, spaced_, stations_, propagation_);
  for (const std::size_t k : spaced_) {
    if (k >= frames_.size()) StateArchive::fail("a number names no frame of the open submap");
  }
}

}  // namespace semantic_mht_slam
