#include "semantic_mht_slam/slam/odometry_continuity.h"

#include <algorithm>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

constexpr int kSteps = 10;  // before which speeds are not known
constexpr double kMostSpeed_m_per_s = 60.0;
constexpr double kFactor = 4.0;          // faster than ever before
constexpr double kGain_m_per_s2 = 20.0;  // that no vehicle exceeds
constexpr double kGainTime_s = 2.0;
constexpr double kJitter_m = 0.5;
constexpr double kJitter_rad = 2.0;
constexpr double kOrigin_m = 0.05;
constexpr double kOrigin_rad = 0.02;
constexpr double kMemory = 0.999;  // of the greatest speed, from step to step

bool isAtOrigin(const Pose& T_odom_base) {
  return T_odom_base.translation_m.norm() < kOrigin_m &&
         angularDistance(T_odom_base.rotation, Eigen::Quaterniond::Identity()) < kOrigin_rad;
}

}  // namespace

bool OdometryContinuity::goesOn(const StampedPose& next) const {
  if (!last_) return true;
  const double pause_s = secondsFromStamp(next.stamp - last_->stamp);
  if (pause_s <= 0.0) return false;
  const Pose step = last_->T_world_base.inverse() * next.T_world_base;
  const double way_m = step.translation_m.norm();
  const double turn_rad = angularDistance(step.rotation, Eigen::Quaterniond::Identity());
  if (way_m > kMostSpeed_m_per_s * pause_s + kJitter_m) return false;
  if (steps_ < kSteps) return true;
  const double short_s = std::min(pause_s, kGainTime_s);
  const bool is_usual = way_m <= 2.0 * speed_m_per_s_ * short_s + kJitter_m;
  if (!is_usual && isAtOrigin(next.T_world_base)) return false;
  const double reach_m = (kFactor * speed_m_per_s_ + kGain_m_per_s2 * short_s) * pause_s + kJitter_m;
  const double reach_rad = kFactor * (turn_rate_rad_per_s_ + short_s) * pause_s + kJitter_rad;
  return way_m <= reach_m && turn_rad <= reach_rad;
}

void OdometryContinuity::add(const StampedPose& next) {
  if (!goesOn(next)) clear();
  if (last_) {
    const double pause_s = secondsFromStamp(next.stamp - last_->stamp);
    const Pose step = last_->T_world_base.inverse() * next.T_world_base;
    const double turn_rad = angularDistance(step.rotation, Eigen::Quaterniond::Identity());
    speed_m_per_s_ = std::max(kMemory * speed_m_per_s_, step.translation_m.norm() / pause_s);
    turn_rate_rad_per_s_ = std::max(kMemory * turn_rate_rad_per_s_, turn_rad / pause_s);
    ++steps_;
  }
  last_ = next;
}

void OdometryContinuity::transfer(StateArchive& archive) {
  archive(last_, steps_, speed_m_per_s_, turn_rate_rad_per_s_);
  archive.require(steps_ >= 0 && speed_m_per_s_ >= 0.0 && turn_rate_rad_per_s_ >= 0.0, "a negative speed");
}

bool mayFollow(const StampedPose& sample, const StampedPose& next) {
  OdometryContinuity continuity;
  continuity.add(sample);
  return continuity.goesOn(next);
}

}  // namespace semantic_mht_slam
