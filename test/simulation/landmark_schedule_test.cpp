#include "semantic_mht_slam/simulation/landmark_schedule.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

/// A drive on the x axis: out, and back again where `returns` is set, `returns` times; one metre a frame.
VehicleMotion shuttle(int length, int returns) {
  VehicleMotion motion;
  for (int lap = 0; lap <= returns; ++lap) {
    for (int i = 0; i < length; ++i) {
      Pose pose;
      pose.translation_m.x() = lap % 2 == 0 ? i : length - i;
      motion.T_world_base.push_back(pose);
      motion.along_m.push_back(lap * length + i);
      motion.stamps.push_back(stampFromSeconds(0.1 * (lap * length + i)));
    }
  }
  return motion;
}

TownObject objectAt(TownClass town_class, double x, double y) {
  TownObject object;
  object.town_class = town_class;
  object.position_m = {x, y, 0.0};
  return object;
}

TEST(FindPassesTest, APassIsTheTimeWithinTheRadius) {
  PassesConfig config;
  config.radius_m = 50.0;
  config.gap_s = 5.0;
  const auto passes = findPasses({objectAt(TownClass::kPole, 200.0, 30.0)}, shuttle(400, 1), config, 10.0);
  ASSERT_EQ(passes[0].size(), 2u);
  EXPECT_EQ(passes[0][0].first_frame, 160);
  EXPECT_EQ(passes[0][0].last_frame, 240);
  EXPECT_EQ(passes[0][1].first_frame, 560);
  EXPECT_EQ(passes[0][1].last_frame, 640);
}

TEST(FindPassesTest, AShortAbsenceDoesNotEndAPass) {
  PassesConfig config;
  config.radius_m = 50.0;
  config.gap_s = 40.0;
  const auto passes = findPasses({objectAt(TownClass::kPole, 200.0, 30.0)}, shuttle(400, 1), config, 10.0);
  ASSERT_EQ(passes[0].size(), 1u);
  EXPECT_EQ(passes[0][0].last_frame, 640);
}

class ParkingTest : public testing::Test {
 protected:
  /// Cars of 400 parking places that are passed twice.
  std::vector<ScheduledLandmark> carsOfTwoPasses() {
    Town town;
    for (int i = 0; i < 400; ++i) town.objects.push_back(objectAt(TownClass::kVehicle, 200.0, 0.05 * i));
    return scheduleLandmarks(town, shuttle(400, 1), scenario_, Rng(1));
  }

  /// How many of them stay for a number of passes.
  static int staying(const std::vector<ScheduledLandmark>& cars, std::size_t passes) {
    return static_cast<int>(std::count_if(cars.begin(), cars.end(),
                                          [&](const ScheduledLandmark& car) { return car.passes.size() == passes; }));
  }

  Scenario scenario_;
};

TEST_F(ParkingTest, CarsLeaveBetweenPassesAsOftenAsConfigured) {
  scenario_.passes.parking_occupancy_prob = 0.6;
  scenario_.passes.parking_stay_prob = 0.5;
  const std::vector<ScheduledLandmark> cars = carsOfTwoPasses();
  // 240 places taken at first, of which 120 keep their car; four binomial deviations
  EXPECT_NEAR(staying(cars, 2), 120, 4 * std::sqrt(400 * 0.3 * 0.7));
  EXPECT_NEAR(staying(cars, 1), 240, 4 * std::sqrt(800 * 0.3 * 0.7));
}

TEST_F(ParkingTest, NobodyLeavesWhereEveryoneStays) {
  scenario_.passes.parking_stay_prob = 1.0;
  EXPECT_EQ(staying(carsOfTwoPasses(), 1), 0);
}

TEST_F(ParkingTest, AFullStreetWithoutStayersHasANewCarForEachPass) {
  scenario_.passes.parking_stay_prob = 0.0;
  scenario_.passes.parking_occupancy_prob = 1.0;
  const std::vector<ScheduledLandmark> cars = carsOfTwoPasses();
  EXPECT_EQ(cars.size(), 800u);
  for (std::size_t i = 0; i < cars.size(); i += 2) {
    EXPECT_NE(cars[i].object.position_m.x(), cars[i + 1].object.position_m.x());
  }
}

TEST(ScheduleTest, ThingsAreThereInEveryPassAndFarOnesAreLeftOut) {
  Town town;
  town.objects = {objectAt(TownClass::kPole, 200.0, 10.0), objectAt(TownClass::kTrunk, 200.0, 900.0)};
  const auto landmarks = scheduleLandmarks(town, shuttle(400, 2), Scenario(), Rng(1));
  ASSERT_EQ(landmarks.size(), 1u);
  EXPECT_EQ(landmarks[0].object.town_class, TownClass::kPole);
  EXPECT_EQ(landmarks[0].passes.size(), 3u);
}

}  // namespace
}  // namespace semantic_mht_slam
