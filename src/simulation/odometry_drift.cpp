#include "semantic_mht_slam/simulation/odometry_drift.h"

#include <cmath>

#include "semantic_mht_slam/simulation/wander.h"

namespace semantic_mht_slam {
namespace {

/// The state of the drift along a drive.
class Drift {
 public:
  Drift(const SimulatedOdometryConfig& config, const Rng& rng)
      : config_(config),
        rng_(rng),
        roll_bias_(config.tilt_bias_rad_per_m, config.bias_length_m, rng_),
        pitch_bias_(config.tilt_bias_rad_per_m, config.bias_length_m, rng_),
        heading_bias_(config.heading_bias_rad_per_m, config.bias_length_m, rng_),
        scale_variation_(config.scale_variation_stddev, config.bias_length_m, rng_),
        scale_(1.0 + rng_.normal(0.0, config.scale_stddev)) {
    const double pitch = rng_.normal(0.0, config.direction_stddev_rad);
    const double yaw = rng_.normal(0.0, config.direction_stddev_rad);
    direction_ = expRotation({0.0, pitch, yaw});
  }

  /// A relative motion as the odometry measures it.
  Pose measure(const Pose& motion) {
    const double distance = motion.translation_m.norm();
    const double root = std::sqrt(distance);
    const double tilt_noise = config_.tilt_noise_rad_per_sqrt_m * root;
    const double roll = roll_bias_.next(distance, rng_) * distance + rng_.normal(0.0, tilt_noise);
    const double pitch = pitch_bias_.next(distance, rng_) * distance + rng_.normal(0.0, tilt_noise);
    const double heading =
        heading_bias_.next(distance, rng_) * distance + rng_.normal(0.0, config_.heading_noise_rad_per_sqrt_m * root);
    const double translation_noise = config_.translation_noise_m_per_sqrt_m * root;
    const Eigen::Vector3d noise(rng_.normal(0.0, translation_noise), rng_.normal(0.0, translation_noise),
                                rng_.normal(0.0, translation_noise));
    const double scale = scale_ + scale_variation_.next(distance, rng_);
    return {(motion.rotation * expRotation({roll, pitch, heading})).normalized(),
            scale * (direction_ * motion.translation_m) + noise};
  }

 private:
  const SimulatedOdometryConfig& config_;
  Rng rng_;
  Wander roll_bias_;
  Wander pitch_bias_;
  Wander heading_bias_;
  Wander scale_variation_;
  double scale_;
  Eigen::Quaterniond direction_;
};

}  // namespace

std::vector<Pose> simulateOdometry(const std::vector<Pose>& T_world_base, const SimulatedOdometryConfig& config,
                                   Rng rng) {
  Drift drift(config, rng);
  std::vector<Pose> T_odom_base;
  for (std::size_t k = 0; k < T_world_base.size(); ++k) {
    if (k == 0) {
      T_odom_base.push_back(Pose::identity());
      continue;
    }
    T_odom_base.push_back(T_odom_base.back() * drift.measure(T_world_base[k - 1].inverse() * T_world_base[k]));
  }
  return T_odom_base;
}

}  // namespace semantic_mht_slam
