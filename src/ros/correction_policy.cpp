#include "semantic_mht_slam/ros/correction_policy.h"

#include <algorithm>

namespace semantic_mht_slam {

Pose limitedStep(const Pose& from, const Pose& to, double distance_m, double angle_rad) {
  const double distance_left_m = (to.translation_m - from.translation_m).norm();
  const double angle_left_rad = angularDistance(from.rotation, to.rotation);
  // One fraction for both, so that place and heading arrive together.
  const double fraction = std::min(distance_left_m > distance_m ? distance_m / distance_left_m : 1.0,
                                   angle_left_rad > angle_rad ? angle_rad / angle_left_rad : 1.0);
  return fraction < 1.0 ? interpolate(from, to, fraction) : to;
}

Pose CorrectionFollower::follow(const Pose& T_map_odom, const Pose& T_odom_base, Stamp stamp,
                                const LiveConfig& config) {
  if (config.correction == CorrectionPolicy::kJump || !stamp_) {
    published_ = T_map_odom;
  } else {
    const double dt_s = std::max(0.0, secondsFromStamp(stamp - *stamp_));
    const Pose T_map_base = T_map_odom * T_odom_base;
    const Pose T_map_base_now = limitedStep(published_ * T_odom_base, T_map_base, config.correction_speed_m_s * dt_s,
                                            config.correction_turn_rate_rad_s * dt_s);
    const bool has_arrived = T_map_base_now.translation_m == T_map_base.translation_m &&
                             T_map_base_now.rotation.coeffs() == T_map_base.rotation.coeffs();
    published_ = has_arrived ? T_map_odom : normalized(T_map_base_now * T_odom_base.inverse());
  }
  stamp_ = stamp;
  return published_;
}

}  // namespace semantic_mht_slam
