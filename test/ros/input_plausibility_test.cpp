#include "semantic_mht_slam/ros/input_plausibility.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

using Change = std::function<Eigen::Vector3d(const Pose& T_odom_base, const Eigen::Vector3d& position_m)>;

/// A drive on a circle among objects; `told` is how the detector tells where it sees one.
InputOddities afterDrive(double metre, const Change& told) {
  Rng rng(1);
  std::vector<Eigen::Vector3d> objects_m;
  for (int i = 0; i < 200; ++i) {
    objects_m.emplace_back(rng.uniform(-60.0, 60.0), rng.uniform(-60.0, 60.0), rng.uniform(0.0, 2.0));
  }
  InputPlausibility plausibility;
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.02 * i;
    const Pose T_odom_base{expRotation({0.0, 0.0, angle}),
                           {metre * 30.0 * std::sin(angle), metre * 30.0 * (1.0 - std::cos(angle)), 0.0}};
    const Pose T_world_base{T_odom_base.rotation, T_odom_base.translation_m / metre};
    plausibility.add(StampedPose{100000000LL * (i + 1), T_odom_base});
    DetectorFrame frame{100000000LL * (i + 1), {}, {}};
    for (const Eigen::Vector3d& object_m : objects_m) {
      const Eigen::Vector3d seen_m = T_world_base.inverse() * object_m;
      if (seen_m.norm() > 25.0) continue;
      frame.detections.emplace_back();
      frame.detections.back().position_m = told(T_world_base, seen_m);
    }
    plausibility.add(frame);
  }
  return plausibility.look();
}

Eigen::Vector3d asItIs(const Pose&, const Eigen::Vector3d& position_m) {
  return position_m;
}

void expectFindings(const InputOddities& oddities, bool odometry_mm, bool objects_mm, bool on_end, bool in_world) {
  EXPECT_EQ(oddities.isOdometryInMillimetres(), odometry_mm) << oddities.speed_m_per_s;
  EXPECT_EQ(oddities.areObjectsInMillimetres(), objects_mm) << oddities.range_m;
  EXPECT_EQ(oddities.areObjectsOnEnd(), on_end) << oddities.height_m;
  EXPECT_EQ(oddities.areObjectsInWorld(), in_world) << oddities.moving_along << " " << oddities.standing;
}

TEST(InputPlausibilityTest, AnOrdinaryDriveIsNotOdd) {
  expectFindings(afterDrive(1.0, asItIs), false, false, false, false);
}

TEST(InputPlausibilityTest, MillimetresAreFound) {
  expectFindings(afterDrive(1000.0, asItIs), true, false, false, false);
  expectFindings(afterDrive(1.0, [](const Pose&, const Eigen::Vector3d& p) -> Eigen::Vector3d { return 1000.0 * p; }),
                 false, true, false, false);
}

TEST(InputPlausibilityTest, CameraAxesAreFound) {
  const auto optical = [](const Pose&, const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return {-p.y() * 0.3, -p.z(), std::abs(p.x()) + 4.0};
  };
  expectFindings(afterDrive(1.0, optical), false, false, true, false);
}

TEST(InputPlausibilityTest, WorldCoordinatesAreFound) {
  expectFindings(afterDrive(1.0, [](const Pose& T, const Eigen::Vector3d& p) -> Eigen::Vector3d { return T * p; }),
                 false, false, false, true);
}

}  // namespace
}  // namespace semantic_mht_slam
