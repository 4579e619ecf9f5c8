#include "semantic_mht_slam/ros/map_update_conversions.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include "support/expect_input_error.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

const SlamConfig kConfig = defaultsOf(Method::kDpmhm);

class MapUpdateTest : public testing::Test {
 protected:
  void SetUp() override {
    SquareDrive(3).feed(slam_, 0, 640);
    slam_.finish();
    last_ = toMessage(slam_.parts(), SubmapId(slam_.map().submaps().size() - 1), classes_);
  }

  void expectRefused(const std::string& field, const std::function<void(MapUpdate&)>& change) {
    MapUpdate bad = last_;
    change(bad);
    expectInputError([&] { fromMessage(bad, classes_); }, {"map_update: field '" + field});
  }

  const ClassTable classes_ = makeStreetClasses();
  Slam slam_{kConfig, classes_};
  MapUpdate last_;
};

TEST_F(MapUpdateTest, MessagesHoldTheDeltasButForTheirResolution) {
  std::size_t sightings = 0;
  std::size_t closures = 0;
  for (const SubmapId id : slam_.map().submaps().ids()) {
    const MapDelta delta = deltaOf(slam_.parts(), id);
    const MapUpdate message = toMessage(slam_.parts(), id, classes_);
    const MapDelta read = fromMessage(message, classes_);
    ASSERT_EQ(message.number, id.index());
    ASSERT_EQ(read.landmarks.size(), delta.landmarks.size());
    for (std::size_t i = 0; i < delta.landmarks.size(); ++i) {
      EXPECT_EQ(read.landmarks[i].id, delta.landmarks[i].id);
      EXPECT_EQ(read.landmarks[i].class_index, delta.landmarks[i].class_index);
      EXPECT_NEAR(read.landmarks[i].existence_prob, delta.landmarks[i].existence_prob, 0.002);
      EXPECT_EQ(read.landmarks[i].observations, delta.landmarks[i].observations);
    }
    EXPECT_EQ(read.duplicates, delta.duplicates);
    EXPECT_EQ(read.T_map_odom.has_value(), delta.T_map_odom.has_value());
    ASSERT_EQ(read.keyframes.size(), delta.keyframes.size());
    for (std::size_t k = 0; k < delta.keyframes.size(); ++k) {
      const DeltaKeyframe& a = read.keyframes[k];
      const DeltaKeyframe& b = delta.keyframes[k];
      EXPECT_NEAR(secondsFromStamp(a.stamp - b.stamp), 0.0, 1e-4);
      EXPECT_NEAR(a.driven.way_m, b.driven.way_m, 1e-3);
      EXPECT_LT((a.T_odom_base.translation_m - b.T_odom_base.translation_m).norm(), 1e-4);
      ASSERT_EQ(a.sightings.size(), b.sightings.size());
      for (std::size_t i = 0; i < a.sightings.size(); ++i, ++sightings) {
        EXPECT_EQ(a.sightings[i].landmark, b.sightings[i].landmark);
        const Eigen::Vector3d apart_m = a.sightings[i].position.mean_m - b.sightings[i].position.mean_m;
        EXPECT_LT(apart_m.cwiseAbs().maxCoeff(), 0.51 * message.resolution);
        EXPECT_NEAR(a.sightings[i].position.cov_m2.trace() / b.sightings[i].position.cov_m2.trace(), 1.0, 0.1);
      }
    }
    ASSERT_EQ(read.closures.size(), delta.closures.size());
    for (std::size_t i = 0; i < delta.closures.size(); ++i, ++closures) {
      EXPECT_EQ(read.closures[i].query_keyframe, delta.closures[i].query_keyframe);
      EXPECT_EQ(read.closures[i].match_keyframe, delta.closures[i].match_keyframe);
      EXPECT_EQ(read.closures[i].pairs, delta.closures[i].pairs);
      EXPECT_TRUE(read.closures[i].cov.isApprox(delta.closures[i].cov, 1e-5));
    }
  }
  EXPECT_GT(sightings, 1000U);
  EXPECT_GT(closures, 3U);
  std::vector<bool> held = heldClosures(last_);
  const std::vector<bool> expected = heldClosures(slam_.map());
  ASSERT_GE(held.size(), expected.size());
  held.resize(expected.size());
  EXPECT_EQ(held, expected);
}

TEST_F(MapUpdateTest, MessagesAreSmall) {
  std::size_t bytes = 0;
  std::size_t sightings = 0;
  for (const SubmapId id : slam_.map().submaps().ids()) {
    const MapUpdate message = toMessage(slam_.parts(), id, classes_);
    bytes += ros::serialization::serializationLength(message);
    sightings += message.sightings.size();
  }
  EXPECT_LT(static_cast<double>(bytes), 22.0 * static_cast<double>(sightings));
}

TEST_F(MapUpdateTest, HostileMessagesAreRefusedByTheirField) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expectRefused("version", [](MapUpdate& update) { update.version = 9; });
  expectRefused("classes_digest", [](MapUpdate& update) { ++update.classes_digest; });
  expectRefused("range_factor", [&](MapUpdate& update) { update.range_factor = nan; });
  expectRefused("resolution", [](MapUpdate& update) { update.resolution = 0.0F; });
  expectRefused("odometry_model", [](MapUpdate& update) { update.odometry_model.pop_back(); });
  expectRefused("odom_base", [](MapUpdate& update) { update.odom_base.orientation.w = 1e300; });
  expectRefused("map_odom", [](MapUpdate& update) {
    update.begins_session = true;
    update.map_odom.position.x = 1e300;
  });
  expectRefused("begin", [](MapUpdate& update) {
    update.begin.sec = 4294967295U;
    update.keyframes.back().after = 1000.0F;
  });
  expectRefused("driven", [](MapUpdate& update) { update.driven = -1.0; });
  expectRefused("landmarks", [](MapUpdate& update) { update.landmarks[0].class_index = 200; });
  expectRefused("landmarks", [](MapUpdate& update) { update.landmarks[1].id = update.landmarks[0].id; });
  expectRefused("landmarks", [](MapUpdate& update) {
    update.landmarks.push_back(update.landmarks.back());
    ++update.landmarks.back().id;
  });
  expectRefused("duplicates", [](MapUpdate& update) { update.duplicates.push_back(1); });
  expectRefused("duplicates", [](MapUpdate& update) { update.duplicates = {0, 1}; });
  expectRefused("keyframes", [](MapUpdate& update) { update.keyframes[0].after = -1.0F; });
  expectRefused("keyframes", [&](MapUpdate& update) { update.keyframes[0].position[1] = nan; });
  expectRefused("keyframes", [](MapUpdate& update) { update.keyframes.back().sightings = 65535; });
  expectRefused("sightings", [](MapUpdate& update) { update.sightings.push_back(update.sightings.back()); });
  expectRefused("sightings", [](MapUpdate& update) { update.sightings[0].landmark = 65535; });
  expectRefused("closures", [](MapUpdate& update) { update.closures.emplace_back(); });
  expectRefused("closures", [](MapUpdate& update) {
    MapUpdateClosure& closure = update.closures.emplace_back();
    closure.query_keyframe = 1;
    closure.source = 77;
  });
  expectRefused("closures", [](MapUpdate& update) {
    MapUpdateClosure& closure = update.closures.emplace_back();
    closure.query_keyframe = 1;
  });
}

}  // namespace
}  // namespace semantic_mht_slam
