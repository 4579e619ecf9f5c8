#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/expect_input_error.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

constexpr int kRound = 480;  // frames

/// The landmarks of a class within a metre of a place on the plane.
std::vector<MixtureLandmark> landmarksAt(const Slam& slam, const Eigen::Vector3d& position_m, ClassIndex class_index) {
  std::vector<MixtureLandmark> landmarks = landmarksOf(slam);
  const std::vector<MixtureLandmark> provisional = provisionalLandmarksOf(slam);
  landmarks.insert(landmarks.end(), provisional.begin(), provisional.end());
  landmarks.erase(std::remove_if(landmarks.begin(), landmarks.end(),
                                 [&](const MixtureLandmark& landmark) {
                                   const Eigen::Vector3d apart_m = landmark.position.mean_m - position_m;
                                   return landmark.mostLikelyClass() != class_index || apart_m.head<2>().norm() > 1.0;
                                 }),
                  landmarks.end());
  return landmarks;
}

/// A landmark of the map without another one of its class within 4 m.
MixtureLandmark loneLandmark(const Slam& slam) {
  const std::vector<MixtureLandmark> landmarks = landmarksOf(slam);
  for (const MixtureLandmark& landmark : landmarks) {
    const auto is_near = [&](const MixtureLandmark& other) {
      const Eigen::Vector3d apart_m = other.position.mean_m - landmark.position.mean_m;
      return other.id != landmark.id && other.mostLikelyClass() == landmark.mostLikelyClass() &&
             apart_m.head<2>().norm() < 4.0;
    };
    if (landmark.id > 100 && std::none_of(landmarks.begin(), landmarks.end(), is_near)) return landmark;
  }
  throw std::logic_error("no lone landmark");
}

std::vector<LandmarkId> idsOf(const std::vector<MixtureLandmark>& landmarks) {
  std::vector<LandmarkId> ids;
  for (const MixtureLandmark& landmark : landmarks) ids.push_back(landmark.id);
  return ids;
}

class SlamRequestsTest : public testing::Test {
 protected:
  static SlamConfig config(bool closes_loops) {
    SlamConfig config = defaultsOf(Method::kDpmhm);
    config.back_end.close_loops = closes_loops;
    return config;
  }

  const SquareDrive drive_{5};
  const ClassTable classes_ = makeStreetClasses();
  Slam slam_{config(true), classes_};
};

TEST_F(SlamRequestsTest, ARemovedLandmarkStaysOutThroughSaveLoadAndTenMoreRounds) {
  drive_.feed(slam_, 0, kRound);
  slam_.finish();
  const MixtureLandmark landmark = loneLandmark(slam_);
  const std::size_t before = landmarksOf(slam_).size();
  slam_.removeLandmark(landmark.id);
  EXPECT_EQ(landmarksOf(slam_).size(), before - 1);
  Slam loaded(config(true), classes_, slam_.snapshot());
  Slam untouched(config(true), classes_);
  drive_.feed(untouched, 0, kRound);
  int seen = 0;
  for (int round = 1; round <= 10; ++round) {
    for (int frame = round * kRound; frame < (round + 1) * kRound; frame += 40) {
      drive_.feed(loaded, frame, frame + 40);
      EXPECT_TRUE(landmarksAt(loaded, landmark.position.mean_m, landmark.mostLikelyClass()).empty()) << frame;
      if (round > 1) continue;
      drive_.feed(untouched, frame, frame + 40);
      seen += landmarksAt(untouched, landmark.position.mean_m, landmark.mostLikelyClass()).empty() ? 0 : 1;
    }
  }
  EXPECT_GT(seen, 0) << "it is there for who did not remove it";
  loaded.finish();
  EXPECT_TRUE(landmarksAt(loaded, landmark.position.mean_m, landmark.mostLikelyClass()).empty());
  EXPECT_NEAR(static_cast<double>(landmarksOf(loaded).size()), static_cast<double>(before), 16.0)
      << "nothing else went";
  loaded.bringBackLandmark(landmark.id);
  EXPECT_TRUE(loaded.map().find(landmark.id));
}

TEST_F(SlamRequestsTest, ARemovedLandmarkStaysOutWithoutLoopClosuresToo) {
  Slam slam(config(false), classes_);
  const auto feedExactly = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      slam.addOdometry({SquareDrive::stampAt(i), drive_.truthAt(i)});
      slam.addDetections(SquareDrive::stampAt(i) - 30000000, drive_.detectionsAt(i));
    }
    slam.finish();
  };
  feedExactly(0, kRound);
  const MixtureLandmark landmark = loneLandmark(slam);
  slam.removeLandmark(landmark.id);
  feedExactly(kRound, 2 * kRound);
  EXPECT_GT(landmarksOf(slam).size(), 250U) << "everything else is there twice";
  EXPECT_TRUE(landmarksAt(slam, landmark.position.mean_m, landmark.mostLikelyClass()).empty());
}

TEST_F(SlamRequestsTest, ALockedLandmarkStaysAsItIs) {
  drive_.feed(slam_, 0, kRound);
  slam_.finish();
  const MixtureLandmark landmark = loneLandmark(slam_);
  slam_.lockLandmark(landmark.id);
  expectInputError([&] { slam_.removeLandmark(landmark.id); }, {"locked"});
  const Pose T_submap_map = slam_.map().T_map_submap(landmark.last_submap).inverse();
  const Eigen::Vector3d locked_m = T_submap_map * landmark.position.mean_m;
  Slam loaded(config(true), classes_, slam_.snapshot());
  drive_.feed(loaded, kRound, 2 * kRound);
  loaded.finish();
  const auto found = loaded.map().find(landmark.id);
  ASSERT_TRUE(found);
  EXPECT_GT(found->second.observations, landmark.observations) << "it was seen again";
  const auto landmarks = landmarksOf(loaded);
  const MixtureLandmark* now = findLandmark(found->second.id, landmarks);
  ASSERT_NE(now, nullptr);
  EXPECT_TRUE(now->is_locked);
  EXPECT_EQ(now->existence_prob, 1.0);
  const Eigen::Vector3d now_m = loaded.map().T_map_submap(landmark.last_submap).inverse() * now->position.mean_m;
  EXPECT_LT((now_m - locked_m).norm(), 1e-9) << "it moves with its submap alone";
  loaded.unlockLandmark(landmark.id);
  expectInputError([&] { loaded.unlockLandmark(landmark.id); }, {"not locked"});
  const auto free = landmarksOf(loaded);
  EXPECT_GT((findLandmark(found->second.id, free)->position.mean_m - now->position.mean_m).norm(), 1e-6);
}

TEST_F(SlamRequestsTest, AnAddedClosureMergesAndARemovedOneGivesBackWhatItMerged) {
  Slam slam(config(false), classes_);
  drive_.feed(slam, 0, kRound + 200);
  slam.finish();
  const auto apart_m = [&](const Slam& s) {
    const auto trajectory = trajectoryOf(s);
    return (trajectory[kRound + 20].T_world_base.translation_m - trajectory[20].T_world_base.translation_m).norm();
  };
  const std::vector<MixtureLandmark> before = landmarksOf(slam);
  const double drift_m = apart_m(slam);
  EXPECT_GT(drift_m, 0.1);
  RequestedClosure closure;
  closure.query = SquareDrive::stampAt(kRound + 20);
  closure.match = SquareDrive::stampAt(20);
  closure.cov.diagonal().setConstant(1e-4);
  const ClosureId id = slam.addClosure(closure);
  EXPECT_LT(apart_m(slam), 0.5 * drift_m);
  EXPECT_GT(slam.map().closures()[id].pairs.size(), 5U);
  EXPECT_EQ(landmarksOf(slam).size(), before.size() - slam.map().closures()[id].pairs.size());
  Slam loaded(config(false), classes_, slam.snapshot());
  EXPECT_EQ(idsOf(landmarksOf(loaded)), idsOf(landmarksOf(slam)));
  loaded.removeClosure(id);
  EXPECT_EQ(loaded.map().closures()[id].reason, "removed by request");
  const std::vector<MixtureLandmark> after = landmarksOf(loaded);
  ASSERT_EQ(idsOf(after), idsOf(before));
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].merged_ids, before[i].merged_ids);
    EXPECT_EQ(after[i].observations, before[i].observations);
    EXPECT_LT((after[i].position.mean_m - before[i].position.mean_m).norm(), 0.2) << after[i].id;
  }
  expectInputError([&] { loaded.removeClosure(id); }, {"does not hold: removed by request"});
  Slam again(config(false), classes_, loaded.snapshot());
  again.finish();
  EXPECT_EQ(idsOf(landmarksOf(again)), idsOf(before)) << "it stays removed";
}

TEST_F(SlamRequestsTest, AClosureOfTheProgramCanBeRemovedAndStaysOut) {
  drive_.feed(slam_, 0, kRound + 300);
  slam_.finish();
  const auto firstAccepted = [this] {
    for (const ClosureId id : slam_.map().closures().ids()) {
      if (slam_.map().closures()[id].is_accepted) return id;
    }
    return ClosureId();
  };
  const std::size_t merged = landmarksOf(slam_).size();
  std::vector<ClosureId> removed;
  for (ClosureId id = firstAccepted(); !id.isNone(); id = firstAccepted()) {
    slam_.removeClosure(id);
    removed.push_back(id);
  }
  ASSERT_GT(removed.size(), 2U);
  EXPECT_GT(landmarksOf(slam_).size(), merged + 20) << "the second pass has landmarks of its own again";
  drive_.feed(slam_, kRound + 300, kRound + 340);
  slam_.finish();
  for (const ClosureId id : removed) EXPECT_FALSE(slam_.map().closures()[id].is_accepted) << id.index();
}

TEST_F(SlamRequestsTest, GoingOnAfterRequestsEqualsNeverHavingStopped) {
  Slam slam(config(false), classes_);
  drive_.feed(slam, 0, kRound + 100);
  RequestedClosure closure;
  closure.query = SquareDrive::stampAt(kRound + 20);
  closure.match = SquareDrive::stampAt(20);
  slam.addClosure(closure);
  slam.removeLandmark(loneLandmark(slam).id);
  slam.lockLandmark(loneLandmark(slam).id);
  Slam loaded(config(false), classes_, slam.snapshot());
  for (Slam* one : {&slam, &loaded}) {
    drive_.feed(*one, kRound + 100, kRound + 200);
    one->finish();
  }
  const auto expected = landmarksOf(slam);
  const auto actual = landmarksOf(loaded);
  ASSERT_EQ(idsOf(actual), idsOf(expected));
  for (std::size_t i = 0; i < actual.size(); ++i) EXPECT_EQ(actual[i].position.mean_m, expected[i].position.mean_m);
}

TEST_F(SlamRequestsTest, WhatThereIsNotIsRefused) {
  expectInputError([&] { slam_.addClosure({}); }, {"no map yet"});
  drive_.feed(slam_, 0, 100);
  expectInputError([&] { slam_.removeLandmark(999999); }, {"no landmark 999999"});
  expectInputError([&] { slam_.lockLandmark(kNoLandmark); }, {"no landmark 0"});
  expectInputError([&] { slam_.bringBackLandmark(1); }, {"not removed"});
  expectInputError([&] { slam_.removeClosure(ClosureId(0)); }, {"no closure 0"});
  RequestedClosure closure;
  closure.query = SquareDrive::stampAt(90);
  closure.match = SquareDrive::stampAt(1000);
  expectInputError([&] { slam_.addClosure(closure); }, {"no pose within a second"});
  closure.match = SquareDrive::stampAt(90);
  expectInputError([&] { slam_.addClosure(closure); }, {"one keyframe"});
  closure.match = SquareDrive::stampAt(5);
  closure.cov(0, 0) = -1.0;
  expectInputError([&] { slam_.addClosure(closure); }, {"positive definite"});
  closure.cov = 1e-14 * FixedAxesCov::Identity();
  expectInputError([&] { slam_.addClosure(closure); }, {"below 1e-6"});
  closure.cov.setZero();
  for (const double far_m : {1e308, -2e7}) {
    closure.T_match_query.translation_m.y() = far_m;
    expectInputError([&] { slam_.addClosure(closure); }, {"beyond 1e7 m"});
  }
  closure.T_match_query.rotation.coeffs().setZero();
  expectInputError([&] { slam_.addClosure(closure); }, {"unit norm"});
}

TEST_F(SlamRequestsTest, ALandmarkHasTheMeanSizeOfItsDetections) {
  for (int i = 0; i < kRound + 200; ++i) {
    Detections detections = drive_.detectionsAt(i);
    for (Detection& detection : detections) {
      if (i % 3 == 0) continue;
      detection.size_m = detection.class_index == 0 ? Eigen::Vector3d(0.2, 0.3, 5.0) : Eigen::Vector3d(0.6, 0.6, 2.0);
      detection.size_m->z() += i % 3 == 1 ? 0.5 : -0.5;
    }
    slam_.addOdometry({SquareDrive::stampAt(i), SquareDrive::odometryAt(i)});
    slam_.addDetections(SquareDrive::stampAt(i) - 30000000, detections);
  }
  slam_.finish();
  Slam loaded(config(true), classes_, slam_.snapshot());
  int known = 0;
  for (const MixtureLandmark& landmark : landmarksOf(loaded)) {
    if (landmark.size.detections < 10 || landmark.class_probs.maxCoeff() < 0.99) continue;
    ++known;
    EXPECT_LE(landmark.size.detections, landmark.observations + 5);
    EXPECT_NEAR(landmark.size.mean_m.z(), landmark.mostLikelyClass() == 0 ? 5.0 : 2.0, 0.6) << landmark.id;
  }
  EXPECT_GT(known, 100);
}

}  // namespace
}  // namespace semantic_mht_slam
