#include <algorithm>
#include <stdexcept>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/slam/slam.h"

// One map, several drives: finding oneself in it, going on in it, and the trajectories of all drives.
namespace semantic_mht_slam {
namespace {

/// Driven between two sessions, for whoever takes what was driven lately for one pass.
constexpr double kBetweenSessions_m = 1000.0;

/// Followed without a fix before the place counts as one that changed, and is mapped again.
constexpr double kFollowed_m = 20.0;

constexpr double kMaxPause_s = 60.0;
constexpr double kMaxSpeed_m_s = 60.0;

}  // namespace

bool goesOn(const StampedPose& last, const StampedPose& next) {
  const double pause_s = secondsFromStamp(next.stamp - last.stamp);
  const double way_m = (next.T_world_base.translation_m - last.T_world_base.translation_m).norm();
  return pause_s > 0.0 && pause_s <= kMaxPause_s && way_m <= kMaxSpeed_m_s * pause_s;
}

void Slam::localize() {
  if (!back_end_) throw std::logic_error("Slam: this method makes no map to localize in");
  if (!localizer_) {
    const Pose T_map_odom = back_end_->T_map_odom();
    endSubmap();
    if (map_.submaps().empty()) throw std::logic_error("Slam: there is no map to localize in");
    localizer_.emplace(localizer_config_);
    localizer_->expectAt(map_.submaps().empty() ? T_map_odom : back_end_->T_map_odom(), 0.0);
  }
  is_mapping_wanted_ = false;
  is_following_ = false;
}

bool Slam::isKnown(const Eigen::Vector3d& position_m) const {
  const int passes = localizer_config_.known_passes;
  return passes > 0 && passesAt(back_end_->keyframes(), position_m) >= passes;
}

bool Slam::isKnownSince(std::size_t first_keyframe) const {
  const auto& closures = back_end_->closures();
  const bool is_tied = std::any_of(closures.rbegin(), closures.rend(), [&](const LoopClosureRecord& closure) {
    return closure.is_accepted && closure.query_keyframe >= static_cast<int>(first_keyframe);
  });
  if (!is_tied) return false;
  const std::vector<Pose>& T_map_keyframe = back_end_->keyframes().T_map_keyframe;
  return std::all_of(T_map_keyframe.begin() + static_cast<std::ptrdiff_t>(first_keyframe), T_map_keyframe.end(),
                     [&](const Pose& pose) { return isKnown(pose.translation_m); });
}

void Slam::follow() {
  endSubmap();
  is_place_known_ = false;
  localizer_.emplace(localizer_config_);
  localizer_->expectAt(back_end_->T_map_odom(), 0.0);
  is_following_ = true;
}

void Slam::resumeMapping() {
  is_mapping_wanted_ = true;
  if (!localizer_ || !localizer_->isLocated()) return;
  driven_m_ += kBetweenSessions_m;
  back_end_->goOnAt(*localizer_->T_map_odom(), driven_m_);
  mapper_->forgetSurroundings();
  localizer_.reset();
  is_following_ = false;
}

void Slam::beginSession() {
  if (mapper_) endSubmap();
  assembler_.beginSession();
  latest_frame_.reset();
  const bool has_map = back_end_ && !map_.submaps().empty();
  sessions_.push_back({odometry_.size(), has_map ? back_end_->keyframes().keyframes.size() : 0, {}});
  localizer_.reset();
  is_place_known_ = is_following_ = false;
  if (has_map) localizer_.emplace(localizer_config_);
}

bool Slam::expectAt(const Pose& T_map_base, double stddev_m) {
  if (!localizer_ || odometry_.size() == sessions_.back().first_odometry) return false;
  localizer_->expectAt(T_map_base * odometry_.back().T_world_base.inverse(), stddev_m);
  return true;
}

void Slam::localizeBy(const Frame& frame) {
  Frame corrected = frame;
  for (Detection& detection : corrected.detections) detection = mapper_->corrected(detection);
  if (localizer_->add(corrected, *back_end_)) {
    sessions_.back().fixes.push_back(localizer_->fix());
    is_following_ = is_mapping_wanted_ && isKnown(localizer_->fix().T_map_base.translation_m);
    if (is_mapping_wanted_ && !is_following_) resumeMapping();
  } else if (is_following_ && localizer_->sinceFix_m() > kFollowed_m) {
    resumeMapping();
  }
}

Pose Slam::T_map_odom() const {
  if (localizer_) return localizer_->T_map_odom().value_or(Pose::identity());
  return back_end_ ? back_end_->T_map_odom() : Pose::identity();
}

TrajectoryRecord Slam::trajectoryRecord() const {
  TrajectoryRecord record{odometry_, {}};
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const Session& session = sessions_[s];
    record.sessions.push_back({session.first_odometry, session.fixes});
    if (!back_end_) continue;
    const KeyframeMap& map = back_end_->keyframes();
    const std::size_t end = s + 1 < sessions_.size() ? sessions_[s + 1].first_keyframe : map.keyframes.size();
    for (std::size_t k = session.first_keyframe; k < end; ++k) {
      const MapKeyframe& keyframe = map.keyframes[k];
      record.sessions.back().fixes.push_back({keyframe.stamp, keyframe.T_odom_base, map.T_map_keyframe[k]});
    }
  }
  return record;
}

std::optional<StampedPose> Slam::latestOdometry() const {
  if (odometry_.size() == sessions_.back().first_odometry) return std::nullopt;
  return odometry_.back();
}

std::optional<StampedPose> Slam::latestPose() const {
  const std::optional<StampedPose> odometry = latestOdometry();
  if (!odometry) return std::nullopt;
  return StampedPose{odometry->stamp, T_map_odom() * odometry->T_world_base};
}

}  // namespace semantic_mht_slam
