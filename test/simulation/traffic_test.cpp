#include "semantic_mht_slam/simulation/traffic.h"

#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr int kFrames = 3000;

class TrafficTest : public testing::Test {
 protected:
  TrafficTest() {
    for (int i = 0; i < 2 * kFrames; ++i) path_.points_m.emplace_back(i * kPathStep_m, 0.0);
    for (int k = 0; k < kFrames; ++k) {
      motion_.along_m.push_back(0.8 * k);
      motion_.T_world_base.push_back({Eigen::Quaterniond::Identity(), {0.8 * k, 0.0, 1.73}});
    }
    scenario_.traffic = {0.0, 0.0, 10.0, 8.0, 3.0};
  }

  /// Number of cars in view, summed over the frames.
  double carFrames() const {
    double sum = 0.0;
    for (const auto& frame : simulate()) sum += static_cast<double>(frame.size());
    return sum;
  }

  std::vector<std::vector<Eigen::Vector3d>> simulate() const {
    return simulateTraffic(path_, motion_, Terrain{}, scenario_, Rng(1));
  }

  VehiclePath path_;
  VehicleMotion motion_;
  Scenario scenario_;
};

TEST_F(TrafficTest, ThereIsNoneWhereNoneIsWanted) {
  EXPECT_EQ(carFrames(), 0.0);
}

TEST_F(TrafficTest, OncomingCarsPassOnTheLeftAtTheirSpeed) {
  scenario_.traffic.oncoming_per_minute = 0.5;
  const auto frames = simulate();
  int steps = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    for (const Eigen::Vector3d& car : frames[k]) {
      EXPECT_EQ(car.y(), 3.0);
      EXPECT_LE(std::abs(car.x() - motion_.along_m[k]), scenario_.passes.radius_m + 1e-9);
    }
    if (frames[k].size() != 1 || frames[k - 1].size() != 1) continue;
    EXPECT_NEAR(frames[k][0].x() - frames[k - 1][0].x(), -0.8, 1e-9);
    ++steps;
  }
  EXPECT_GT(steps, 30);
}

TEST_F(TrafficTest, CarsComeAsOftenAsConfigured) {
  scenario_.traffic.oncoming_per_minute = 30.0;  // 150 in 300 s, in view for 120 m at 16 m/s
  EXPECT_NEAR(carFrames() / 75.0, 150.0, 4.0 * std::sqrt(150.0) + 6.0);
}

TEST_F(TrafficTest, LeadingCarsStayAheadAtAConstantGapForTheMeanTime) {
  scenario_.traffic.leading_per_minute = 30.0;
  EXPECT_NEAR(carFrames() / 100.0, 150.0, 4.0 * std::sqrt(2.0 * 150.0) + 6.0);
  const auto frames = simulate();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (const Eigen::Vector3d& car : frames[k]) EXPECT_NEAR(car.x() - motion_.along_m[k], 20.0, 10.0 + 1e-9);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
