#include "semantic_mht_slam/bags/map_update_conversions.h"

#include <algorithm>
#include <functional>
#include <limits>

#include <Eigen/Eigenvalues>
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
    MapUpdate bad = toMessage(slam_.parts(), SubmapId(0), classes_);
    change(bad);
    expectInputError([&] { fromMessage(bad, classes_); }, {"map_update: field '" + field});
  }

  const ClassTable classes_ = makeStreetClasses();
  Slam slam_{kConfig, classes_};
  MapUpdate last_;
};

void expectSameLandmarks(const MapUpdate& message, const MapDelta& read, const MapDelta& delta) {
  ASSERT_EQ(read.landmarks.size(), delta.landmarks.size());
  for (std::size_t i = 0; i < delta.landmarks.size(); ++i) {
    const DeltaLandmark& a = read.landmarks[i];
    const DeltaLandmark& b = delta.landmarks[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.class_index, b.class_index);
    EXPECT_NEAR(a.existence_prob, b.existence_prob, 0.002);
    EXPECT_EQ(a.observations, std::min(255, b.observations));
    EXPECT_EQ(a.keyframe, b.keyframe);
    EXPECT_LT((a.position.mean_m - b.position.mean_m).cwiseAbs().maxCoeff(), 0.51 * message.landmark_step);
    EXPECT_NEAR(a.position.cov_m2.trace() / b.position.cov_m2.trace(), 1.0, 0.1);
  }
}

void expectSameKeyframes(const MapDelta& read, const MapDelta& delta) {
  ASSERT_EQ(read.keyframes.size(), delta.keyframes.size());
  for (std::size_t k = 0; k < delta.keyframes.size(); ++k) {
    const DeltaKeyframe& a = read.keyframes[k];
    const DeltaKeyframe& b = delta.keyframes[k];
    EXPECT_NEAR(secondsFromStamp(a.stamp - b.stamp), 0.0, 1e-4);
    EXPECT_NEAR(a.driven.way_m, b.driven.way_m, 1e-3);
    const Pose apart = a.T_previous_keyframe.inverse() * b.T_previous_keyframe;
    EXPECT_LT(apart.translation_m.norm(), 1e-3);
    EXPECT_LT(logRotation(apart.rotation).norm(), 1e-4);
    EXPECT_EQ(a.landmarks, b.landmarks);
  }
}

/// As wide in every direction, but for a fifth.
void expectAlike(const PoseCov& a, const PoseCov& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<PoseCov> ratios(a, b);
  EXPECT_GT(ratios.eigenvalues().minCoeff(), 0.64);
  EXPECT_LT(ratios.eigenvalues().maxCoeff(), 1.44);
}

TEST_F(MapUpdateTest, MessagesHoldTheDeltasButForTheirResolution) {
  std::size_t keyframes = 0;
  std::size_t closures = 0;
  for (const SubmapId id : slam_.map().submaps().ids()) {
    const MapDelta delta = deltaOf(slam_.parts(), id);
    const MapUpdate message = toMessage(slam_.parts(), id, classes_);
    const MapDelta read = fromMessage(message, classes_);
    ASSERT_EQ(message.number, id.index());
    expectSameLandmarks(message, read, delta);
    expectSameKeyframes(read, delta);
    EXPECT_EQ(read.duplicates, delta.duplicates);
    EXPECT_EQ(read.begins_session, delta.begins_session);
    EXPECT_NEAR(read.odometry.systematic.scale_translation.mean, delta.odometry.systematic.scale_translation.mean,
                1e-8);
    EXPECT_NEAR(read.odometry.noise.tilt_rad_per_sqrt_m, delta.odometry.noise.tilt_rad_per_sqrt_m, 1e-8);
    ASSERT_EQ(read.closures.size(), delta.closures.size());
    for (std::size_t i = 0; i < delta.closures.size(); ++i, ++closures) {
      EXPECT_EQ(read.closures[i].query_keyframe, delta.closures[i].query_keyframe);
      EXPECT_EQ(read.closures[i].match_keyframe, delta.closures[i].match_keyframe);
      EXPECT_EQ(read.closures[i].pairs, delta.closures[i].pairs);
      expectAlike(read.closures[i].cov, delta.closures[i].cov);
    }
    keyframes += read.keyframes.size();
  }
  EXPECT_EQ(keyframes, slam_.map().keyframes().size());
  EXPECT_GT(closures, 3U);
  std::vector<bool> held = heldClosures(last_);
  const std::vector<bool> expected = heldClosures(slam_.map());
  ASSERT_GE(held.size(), expected.size());
  held.resize(expected.size());
  EXPECT_EQ(held, expected);
}

TEST_F(MapUpdateTest, AnOdometryThatBeginsFarAwayKeepsItsPlace) {
  Slam far(kConfig, classes_);
  const Eigen::Vector3d origin_m(512345.125, 5432109.25, 417.0);  // UTM
  const SquareDrive square(3);
  for (int i = 0; i < 60; ++i) {
    Pose T_odom_base = SquareDrive::odometryAt(i);
    T_odom_base.translation_m += origin_m;
    far.addOdometry({SquareDrive::stampAt(i), T_odom_base});
    far.addDetections(SquareDrive::stampAt(i) - 30000000, square.detectionsAt(i));
  }
  far.finish();
  const MapDelta read = fromMessage(toMessage(far.parts(), SubmapId(0), classes_), classes_);
  const Pose& first = read.keyframes.front().T_previous_keyframe;
  EXPECT_LT((first.translation_m - far.map().keyframes()[KeyframeId(0)].T_odom_base.translation_m).norm(), 1e-6);
}

/// What a kilometre of a town takes follows from how much is in it: 19 bytes a landmark and submap, 24 a keyframe, 8 a
/// pair of landmarks; some 80 a closure and 220 a submap.
TEST_F(MapUpdateTest, MessagesAreAsSmallAsTheirLists) {
  for (const SubmapId id : slam_.map().submaps().ids()) {
    const MapUpdate message = toMessage(slam_.parts(), id, classes_);
    std::size_t places = 0;
    for (const MapUpdateClosure& closure : message.closures) places += closure.pairs.size();
    EXPECT_LE(ros::serialization::serializationLength(message),
              230 + 19 * message.landmarks.size() + 24 * message.keyframes.size() + message.shown.size() +
                  78 * message.closures.size() + 2 * places + 4 * message.pairs.size() + 4 * message.duplicates.size() +
                  message.closures_held.size());
  }
}

TEST_F(MapUpdateTest, HostileMessagesAreRefusedByTheirField) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expectRefused("classes_digest", [](MapUpdate& update) { ++update.classes_digest; });
  expectRefused("range_factor", [&](MapUpdate& update) { update.range_factor = nan; });
  expectRefused("landmark_step", [](MapUpdate& update) { update.landmark_step = 0.0F; });
  expectRefused("keyframe_step", [&](MapUpdate& update) { update.keyframe_step = nan; });
  expectRefused("odometry_noise", [](MapUpdate& update) { update.odometry_noise[2] = -1.0F; });
  expectRefused("odometry_errors", [&](MapUpdate& update) { update.odometry_errors[0] = nan; });
  expectRefused("first_rotation", [&](MapUpdate& update) { update.first_rotation[0] = nan; });
  expectRefused("first_position", [](MapUpdate& update) { update.first_position[0] = 1e300; });
  expectRefused("begin", [](MapUpdate& update) {
    update.begin.sec = 4294967295U;
    update.keyframes.back().after = 1000.0F;
  });
  expectRefused("driven", [](MapUpdate& update) { update.driven = -1.0; });
  expectRefused("landmarks", [](MapUpdate& update) { update.landmarks[0].class_index = 200; });
  expectRefused("landmarks", [](MapUpdate& update) { update.landmarks[1].id = update.landmarks[0].id; });
  expectRefused("landmarks", [](MapUpdate& update) { update.landmarks[0].keyframe = 255; });
  expectRefused("shown", [](MapUpdate& update) { update.shown.push_back(0); });
  expectRefused("shown", [](MapUpdate& update) { std::fill(update.shown.begin(), update.shown.end(), 0); });
  expectRefused("duplicates", [](MapUpdate& update) { update.duplicates.push_back(1); });
  expectRefused("duplicates", [](MapUpdate& update) { update.duplicates = {0, 1}; });
  expectRefused("pairs", [](MapUpdate& update) { update.pairs.push_back(1); });
  expectRefused("keyframes", [](MapUpdate& update) { update.keyframes[0].after = -1.0F; });
  expectRefused("keyframes", [&](MapUpdate& update) { update.keyframes[0].driven = nan; });
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
  expectRefused("closures", [](MapUpdate& update) {
    MapUpdateClosure& closure = update.closures.emplace_back();
    closure.query_keyframe = 1;
    closure.stddev.fill(1.0F);
    closure.pairs = {65535};
  });
}

}  // namespace
}  // namespace semantic_mht_slam
