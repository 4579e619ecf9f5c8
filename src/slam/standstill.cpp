#include "semantic_mht_slam/slam/standstill.h"

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMoved_m = 0.05;
constexpr double kMoved_rad = 0.01;

}  // namespace

bool Standstill::hasMoved(const Pose& T_odom_base) const {
  return !T_odom_stand_ || (T_odom_base.translation_m - T_odom_stand_->translation_m).norm() > kMoved_m ||
         angularDistance(T_odom_base.rotation, T_odom_stand_->rotation) > kMoved_rad;
}

bool Standstill::add(const Pose& T_odom_base) {
  if (hasMoved(T_odom_base)) {
    T_odom_stand_ = T_odom_base;
    frames_ = 0;
  }
  if (frames_ >= kFrames) return true;
  ++frames_;
  return false;
}

void Standstill::transfer(StateArchive& archive) {
  archive(T_odom_stand_, frames_);
  archive.require(frames_ >= 0 && frames_ <= kFrames, "a number of frames from one place that there cannot be");
}

}  // namespace semantic_mht_slam
