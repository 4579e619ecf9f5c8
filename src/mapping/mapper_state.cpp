#include <algorithm>
#include <cmath>
#include <set>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/map/map_state.h"
#include "semantic_mht_slam/mapping/hypothesis_state.h"
#include "semantic_mht_slam/mapping/mapper.h"
#include "semantic_mht_slam/models/detection_state.h"

#include "bias_equations.h"

// What of the mapper outlives a program: the open submap with its hypotheses, and all that was learned on the way.
namespace semantic_mht_slam {
namespace {

constexpr int kMostCounted = 1 << 29;  // that can be doubled

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
  std::int64_t sum = 0;
  for (const int bin : bins_) {
    archive.require(bin >= 0, "a negative count");
    sum += bin;
  }
  archive.require(sum == count_ && count_ > 0 && count_ <= kMostCounted, "a median of other values than were counted");
  if (archive.isReading()) {
    median_bin_ = below_ = 0;
    moveToMedian();
  }
}

void DetectorCalibration::PastFrame::transfer(StateArchive& archive) {
  archive(T_odom_base, positions_m, classes);
  if (classes.size() != positions_m.size()) StateArchive::fail("a frame with more positions than classes");
  for (const ClassIndex class_index : classes) archive.requireClass(class_index);
}

void DetectorCalibration::ClassStatistics::transfer(StateArchive& archive) {
  archive(noise, wander, wander_distance_m);
}

void DetectorCalibration::transfer(StateArchive& archive) {
  transferFixed(archive, statistics_);
  archive(past_, detections_, neighbours_);
  archive.require(neighbours_ <= detections_, "more neighbours than detections");
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
  archive.require(detected >= 0.0 && detected <= frames, "more detections than frames");
}

void DetectionRate::transfer(StateArchive& archive) {
  transferFixed(archive, cells_);
}

void ClassConfusion::transfer(StateArchive& archive) {
  transferFixed(archive, counts_);
  for (const double count : counts_) archive.require(count >= 0.0, "a negative count");
  for (ClassIndex object = 0; object < class_count_; ++object) evaluate(object);
}

void ClutterModel::Counts::transfer(StateArchive& archive) {
  archive(clutter, births);
  archive.require(clutter >= 0.0 && births >= 0.0, "a negative count");
}

void ClutterModel::transfer(StateArchive& archive) {
  transferFixed(archive, of_class_);
  transferFixed(archive, of_cell_);
  archive(frames_);
  archive.require(frames_ >= 0.0, "a negative count");
}

void NeighbourDensity::Neighbours::transfer(StateArchive& archive) {
  archive(objects, looks, first, pairs, all_pairs, height_squares_m2);
  const auto areCounts = [](const auto& counts) {
    return std::all_of(counts.begin(), counts.end(), [](double count) { return count >= 0.0; });
  };
  const bool are_counts = areCounts(looks) && areCounts(first) && areCounts(pairs);
  archive.require(are_counts && objects >= 0.0 && all_pairs >= 0.0 && height_squares_m2 >= 0.0, "a negative count");
}

void NeighbourDensity::transfer(StateArchive& archive) {
  transferFixed(archive, of_class_);
}

void MapBranching::transfer(StateArchive& archive) {
  auto& [landmarks, stddev_xy_m, stddev_z_m, stddev_yaw_rad] = map_;
  archive(landmarks, stddev_xy_m, stddev_z_m, stddev_yaw_rad);
  archive.require(stddev_xy_m >= 0.0 && stddev_z_m >= 0.0 && stddev_yaw_rad >= 0.0, "a negative deviation");
  archive.require(areRising(landmarks, [](const MixtureLandmark& landmark) { return landmark.id; }),
                  "an earlier map whose ids do not rise");
  if (archive.isReading()) restart(std::move(map_));
  archive(next_attempt_m_);
}

void MultiHypothesisTree::transfer(StateArchive& archive) {
  archive(tracking_.detectionRate(), model_.confusion(), model_.clutter(), model_.neighbours(), branching_);
  transferLeaves(archive, leaves_);
  archive(next_hypothesis_id_);
  for (const MapHypothesis& leaf : leaves_) {
    archive.require(leaf.id < next_hypothesis_id_, "a hypothesis with an id that is still to be given");
    for (const HypothesisLandmark& landmark : leaf.landmarks) {
      const int earlier = landmark->earlier;
      archive.require(earlier >= -1 && earlier < branching_.earlierLandmarks(),
                      "a landmark that the earlier map lacks");
      archive.require(!landmark->is_expected || (earlier >= 0 && leaf.map_offset), "a landmark that nobody expects");
    }
  }
}

void LandmarkPropagation::transfer(StateArchive& archive) {
  archive(T_odom_last_, last_offset_);
  transferLandmarks(archive, landmarks_);
  transferLandmarks(archive, resting_);
  for (const auto* landmarks : {&landmarks_, &resting_}) {
    for (const HypothesisLandmark& landmark : *landmarks) {
      archive.require(landmark->updated_at_m == 0.0, "a landmark that was seen in a submap that has not begun");
    }
  }
}

void StationKeeping::Seen::transfer(StateArchive& archive) {
  archive(place, measurement, T_station_base, detection);
}

bool StationKeeping::fits(const std::vector<Frame>& frames) const {
  for (const Station& station : stations_) {
    for (const Seen& seen : station.seen) {
      if (seen.place >= frames.size() || seen.measurement >= frames[seen.place].detections.size()) return false;
    }
  }
  return true;
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
  archive(movers_, track_of_detection_, spans_, driven_m_, moving_counts_);
  transferAssociations(archive, moving_);
  for (const std::size_t k : spaced_) {
    if (k >= frames_.size()) StateArchive::fail("a number names no frame of the open submap");
  }
  if (archive.isReading()) requireOpenSubmap(archive);
}

/// Whether the tracks are those of the detections of these frames.
bool Mapper::areTracked(const std::vector<Frame>& frames) const {
  if (track_of_detection_.size() != frames.size()) return false;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (track_of_detection_[k].size() != frames[k].detections.size()) return false;
    for (const auto& track : track_of_detection_[k]) {
      if (track && !movers_.knows(*track)) return false;
    }
  }
  return true;
}

/// The open submap: its frames are those that its hypotheses tell of.
void Mapper::requireOpenSubmap(const StateArchive& archive) const {
  archive.require(is_open_ != frames_.empty(), "a submap without frames, or frames without a submap");
  archive.require(areRising(frames_, [](const Frame& frame) { return frame.index; }) &&
                      areRising(frames_, [](const Frame& frame) { return frame.stamp; }) &&
                      areRising(spaced_, [](std::size_t k) { return k; }),
                  "frames that are not in order");
  archive.require(stations_.fits(frames_), "a number names no detection of the open submap");
  archive.require(areTracked(frames_), "tracks of other detections than the submap has");
  if (!is_open_) return;
  Motion driven;
  for (std::size_t k = 1; k < frames_.size(); ++k) {
    driven = driven + motionOf(frames_[k - 1].T_odom_base.inverse() * frames_[k].T_odom_base);
  }
  archive.require(std::abs(driven.way_m - motion_.way_m) <= kRounding * (1.0 + motion_.way_m) &&
                      std::abs(driven.turn_rad - motion_.turn_rad) <= kRounding * (1.0 + motion_.turn_rad),
                  "a submap whose frames lead another way than it was driven");
  for (const MapHypothesis& leaf : tree_.leaves()) {
    for (const HypothesisLandmark& landmark : leaf.landmarks) {
      const bool is_past = landmark->updated_at_m >= 0.0 && landmark->updated_at_m <= motion_.way_m;
      archive.require(is_past, "a landmark that was seen before the submap began, or is still to be seen");
    }
  }
  std::set<const AssociationRecord*> known;  // branches share their beginnings
  for (const MapHypothesis& leaf : tree_.leaves()) {
    const AssociationRecord* record = leaf.history.get();
    for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame, record = record->previous.get()) {
      const bool fits = record != nullptr && record->frame == frame->index &&
                        record->landmark_of_measurement.size() == frame->detections.size();
      archive.require(fits, "a hypothesis of other frames than the submap has");
      if (!known.insert(record).second) break;
    }
    archive.require(record == nullptr || known.count(record) > 0, "a hypothesis of more frames than the submap has");
  }
}

bool Mapper::fits(std::size_t finished_submaps) const {
  if (id_.isNone()) return finished_submaps == 0 && !is_open_;
  return id_.index() + (is_open_ ? 0 : 1) == finished_submaps;
}

}  // namespace semantic_mht_slam
