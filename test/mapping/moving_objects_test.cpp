#include "semantic_mht_slam/mapping/moving_objects.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

constexpr double kNoise_m = 0.3;
constexpr double kPeriod_s = 0.1;

/// Objects that start at a place and move at a velocity, each seen with probability .8 a frame. Returns the track of
/// each object's last sighting.
class MovingObjectsTest : public testing::Test {
 protected:
  struct Object {
    Eigen::Vector2d start_m;
    Eigen::Vector2d velocity_mps;
    std::optional<MovingObjects::TrackId> track = {};
  };

  void drive(int frames, std::vector<Object>& objects) {
    for (int k = 0; k < frames; ++k, ++frame_) {
      std::vector<MovableSighting> sightings;
      std::vector<Object*> seen;
      for (Object& object : objects) {
        if (!rng_.bernoulli(0.8)) continue;
        const Eigen::Vector2d noise(rng_.normal(0.0, kNoise_m), rng_.normal(0.0, kNoise_m));
        const Eigen::Vector2d position_m = object.start_m + frame_ * kPeriod_s * object.velocity_mps + noise;
        sightings.push_back({0, position_m, kNoise_m * kNoise_m * Eigen::Matrix2d::Identity(), 0.01});
        seen.push_back(&object);
      }
      const auto tracks = movers_.add(stampFromSeconds(frame_ * kPeriod_s), 1.0 * frame_, sightings);
      for (std::size_t i = 0; i < seen.size(); ++i) seen[i]->track = tracks.at(i);
    }
  }

  double probOf(const Object& object) const { return movers_.movingProb(object.track.value()); }

  Rng rng_{1};
  int frame_ = 0;
  MovingObjects movers_{{}, 1, 6.0};
};

TEST_F(MovingObjectsTest, TellsCarsThatDriveFromCarsThatStand) {
  std::vector<Object> objects = {
      {{0.0, 0.0}, {0.0, 0.0}}, {{10.0, 0.0}, {0.0, 0.0}}, {{-30.0, 4.0}, {10.0, 0.0}}, {{60.0, -4.0}, {-8.0, 0.0}}};
  drive(15, objects);
  EXPECT_LT(probOf(objects[0]), 0.05);
  EXPECT_LT(probOf(objects[1]), 0.05);
  EXPECT_GT(probOf(objects[2]), 0.95);
  EXPECT_GT(probOf(objects[3]), 0.95);
}

TEST_F(MovingObjectsTest, ParkedCarsInARowStand) {
  std::vector<Object> objects;
  for (int i = 0; i < 12; ++i) objects.push_back({{4.0 * i, 3.0}, {0.0, 0.0}});
  drive(20, objects);
  for (const Object& object : objects) EXPECT_LT(probOf(object), 0.1);
}

TEST_F(MovingObjectsTest, ACarIsOneTrackAndPassesParkedOnesWithoutTakingThemAlong) {
  std::vector<Object> objects = {{{0.0, 0.0}, {12.0, 0.0}}};
  for (int i = 0; i < 6; ++i) objects.push_back({{5.0 * i, 3.0}, {0.0, 0.0}});
  drive(5, objects);
  const MovingObjects::TrackId track = objects[0].track.value();
  drive(20, objects);
  EXPECT_EQ(objects[0].track.value(), track);
  EXPECT_GT(probOf(objects[0]), 0.95);
  for (std::size_t i = 1; i < objects.size(); ++i) EXPECT_LT(probOf(objects[i]), 0.1) << i;
}

TEST_F(MovingObjectsTest, OneSightingSaysNothing) {
  std::vector<Object> objects = {{{0.0, 0.0}, {0.0, 0.0}}};
  while (!objects[0].track) drive(1, objects);
  EXPECT_NEAR(probOf(objects[0]), MovingConfig().prior_prob, 1e-9);
}

TEST_F(MovingObjectsTest, TracksThatEndedAreForgottenWhenTold) {
  std::vector<Object> objects = {{{0.0, 0.0}, {0.0, 0.0}}};
  drive(5, objects);
  std::vector<Object> none;
  drive(20, none);
  EXPECT_TRUE(movers_.knows(objects[0].track.value()));
  movers_.forgetEnded();
  EXPECT_FALSE(movers_.knows(objects[0].track.value()));
}

}  // namespace
}  // namespace semantic_mht_slam
