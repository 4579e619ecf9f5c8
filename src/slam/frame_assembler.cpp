#include "semantic_mht_slam/slam/frame_assembler.h"

#include <algorithm>

#include "semantic_mht_slam/common/ros_time.h"
#include "semantic_mht_slam/models/usable_detection.h"

namespace semantic_mht_slam {
namespace {

constexpr double kFurthest_m = 1e10;     // where a double still tells micrometres
constexpr Stamp kDisorder = 1000000000;  // frames of one detector do not come in disorder by more

}  // namespace

bool isUsable(const StampedPose& T_odom_base) {
  const Pose& pose = T_odom_base.T_world_base;
  return isRosTime(T_odom_base.stamp) && pose.isValid() && (pose.translation_m.cwiseAbs().array() <= kFurthest_m).all();
}

void describe(FrameAssemblerConfig& config, Fields& fields) {
  fields.add("max_odometry_gap", config.max_odometry_gap_s, "s", {1e-3, 60.0},
             "Detections between odometry samples further apart than this are dropped.");
  fields.add("odometry_history", config.odometry_history_s, "s", {0.1, 600.0},
             "How long odometry is kept for detections that come late.");
  fields.add("max_waiting_frames", config.max_waiting_frames, "", {1, 1000000},
             "Detector frames that may wait for odometry; beyond that the oldest is dropped.");
}

InputCounters operator-(InputCounters counters, const InputCounters& before) {
  for (const auto member :
       {&InputCounters::odometry, &InputCounters::odometry_invalid, &InputCounters::odometry_not_rising,
        &InputCounters::odometry_outliers, &InputCounters::frames, &InputCounters::frames_before_odometry,
        &InputCounters::frames_not_rising, &InputCounters::frames_far_ahead, &InputCounters::frames_in_odometry_gap,
        &InputCounters::frames_waiting_too_long, &InputCounters::detections, &InputCounters::detections_invalid,
        &InputCounters::detections_at_origin, &InputCounters::covariances_unknown, &InputCounters::frames_standing}) {
    counters.*member -= before.*member;
  }
  return counters;
}

FrameAssembler::FrameAssembler(const FrameAssemblerConfig& config) : config_(config) {}

bool FrameAssembler::addOdometry(const StampedPose& T_odom_base) {
  if (!isUsable(T_odom_base)) {
    ++counters_.odometry_invalid;
    return false;
  }
  if (!odometry_.empty() && T_odom_base.stamp <= odometry_.back().stamp) {
    ++counters_.odometry_not_rising;
    return false;
  }
  odometry_.push_back(T_odom_base);
  ++counters_.odometry;
  forgetOldOdometry();
  return true;
}

void FrameAssembler::beginSession(Stamp begin) {
  odometry_.clear();
  const auto is_before = [&](const WaitingFrame& frame) { return frame.stamp < begin; };
  const auto first = std::stable_partition(waiting_.begin(), waiting_.end(), is_before);
  counters_.frames_waiting_too_long += static_cast<std::size_t>(first - waiting_.begin());
  waiting_.erase(waiting_.begin(), first);
  last_taken_.reset();
}

void FrameAssembler::forgetOldOdometry() {
  // Frames that wait already need their odometry however old it is.
  Stamp oldest_needed = odometry_.back().stamp - stampFromSeconds(config_.odometry_history_s);
  if (!waiting_.empty()) oldest_needed = std::min(oldest_needed, waiting_.front().stamp);
  while (odometry_.size() > 2 && odometry_[1].stamp <= oldest_needed) odometry_.pop_front();
}

void FrameAssembler::addDetections(Stamp stamp, Detections detections) {
  const std::size_t index = next_index_++;
  if (!isRosTime(stamp)) {
    ++(stamp < 0 ? counters_.frames_not_rising : counters_.frames_far_ahead);
    return;
  }
  dropOutlierBefore(stamp);
  if (newest() && stamp <= *newest()) {
    ++counters_.frames_not_rising;
    return;
  }
  if (!odometry_.empty() && stamp > odometry_.back().stamp + stampFromSeconds(config_.odometry_history_s)) {
    ++counters_.frames_far_ahead;  // and must not make the frames that follow look late
    return;
  }
  counters_.covariances_unknown += forgetUnknownCovariances(detections);
  counters_.detections_at_origin += removeAtOrigin(detections);
  counters_.detections_invalid += removeUnusable(detections);
  waiting_.push_back({index, stamp, std::move(detections)});
  const std::size_t most = config_.max_waiting_frames;
  if (waiting_.size() > most) {
    last_taken_ = waiting_.front().stamp;
    waiting_.pop_front();
    ++counters_.frames_waiting_too_long;
  }
}

/// One frame stamped far ahead of those before and after it costs itself alone, if it still waits.
void FrameAssembler::dropOutlierBefore(Stamp stamp) {
  if (waiting_.empty() || stamp > waiting_.back().stamp - kDisorder) return;
  const std::optional<Stamp> before = waiting_.size() > 1 ? waiting_[waiting_.size() - 2].stamp : last_taken_;
  if (before && stamp <= *before) return;
  waiting_.pop_back();
  ++counters_.frames_not_rising;
}

std::optional<Frame> FrameAssembler::next() {
  while (!waiting_.empty() && !odometry_.empty() && waiting_.front().stamp <= odometry_.back().stamp) {
    WaitingFrame waiting = std::move(waiting_.front());
    waiting_.pop_front();
    last_taken_ = waiting.stamp;
    if (const auto T_odom_base = interpolatedOdometry(waiting.stamp)) {
      ++counters_.frames;
      counters_.detections += waiting.detections.size();
      return Frame{waiting.index, waiting.stamp, *T_odom_base, std::move(waiting.detections)};
    }
  }
  return std::nullopt;
}

std::optional<Pose> FrameAssembler::interpolatedOdometry(Stamp stamp) {
  const auto after = std::lower_bound(odometry_.begin(), odometry_.end(), stamp,
                                      [](const StampedPose& pose, Stamp s) { return pose.stamp < s; });
  if (after->stamp == stamp) return after->T_world_base;
  if (after == odometry_.begin()) {
    ++counters_.frames_before_odometry;
    return std::nullopt;
  }
  const auto before = after - 1;
  const Stamp gap = after->stamp - before->stamp;
  if (gap > stampFromSeconds(config_.max_odometry_gap_s)) {
    ++counters_.frames_in_odometry_gap;
    return std::nullopt;
  }
  const double fraction = static_cast<double>(stamp - before->stamp) / static_cast<double>(gap);
  return interpolate(before->T_world_base, after->T_world_base, fraction);
}

}  // namespace semantic_mht_slam
