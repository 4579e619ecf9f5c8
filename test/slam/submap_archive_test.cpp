#include "semantic_mht_slam/slam/submap_archive.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

MixtureLandmark makeLandmark(LandmarkId id, double x, double existence) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position = {{x, 0.0, 0.0}, Eigen::Vector3d(0.04, 0.01, 0.09).asDiagonal()};
  landmark.components = {{1.0, landmark.position}};
  landmark.existence_prob = existence;
  return landmark;
}

std::shared_ptr<const Submap> makeSubmap(const Pose& T_odom_submap, std::vector<MixtureLandmark> landmarks,
                                         std::vector<DetectionAssociation> associations,
                                         std::vector<MergedLandmark> merged) {
  auto submap = std::make_shared<Submap>();
  submap->T_odom_submap = T_odom_submap;
  submap->landmarks = std::move(landmarks);
  submap->associations = std::move(associations);
  submap->merged = std::move(merged);
  return submap;
}

std::vector<MixtureLandmark> landmarksOf(const SubmapArchive& archive) {
  std::vector<MixtureLandmark> landmarks;
  auto merged_into = archive.mergedInto();
  archive.forEachLandmark([&](int submap, const MixtureLandmark& landmark) {
    landmarks.push_back(transformed(archive.submaps()[static_cast<std::size_t>(submap)]->T_odom_submap, landmark));
    landmarks.back().merged_ids = merged_into[landmark.id];
  });
  return landmarks;
}

TEST(SubmapArchiveTest, TheLastSubmapThatSawALandmarkPlacesIt) {
  SubmapArchive archive(0.5);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(1, 5.0, 0.9)}, {}, {}));
  const Pose T_odom_submap{expRotation({0.0, 0.0, M_PI / 2.0}), {10.0, 0.0, 0.0}};
  archive.add(makeSubmap(T_odom_submap, {makeLandmark(1, 2.0, 0.9)}, {}, {}));
  const auto landmarks = landmarksOf(archive);
  ASSERT_EQ(landmarks.size(), 1U);
  EXPECT_LT((landmarks[0].position.mean_m - Eigen::Vector3d(10.0, 2.0, 0.0)).norm(), 1e-12);
  EXPECT_NEAR(landmarks[0].position.cov_m2(0, 0), 0.01, 1e-12) << "the covariance turns with the submap";
  EXPECT_LT((landmarks[0].components[0].position.mean_m - landmarks[0].position.mean_m).norm(), 1e-12);
}

TEST(SubmapArchiveTest, MergedIdsStayResolvableThroughChains) {
  SubmapArchive archive(0.5);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(2, 0.0, 0.9)}, {{0, 0, 1}, {0, 1, 2}}, {{1, 2}}));
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(3, 0.0, 0.9)}, {{1, 0, 3}}, {{2, 3}}));
  EXPECT_EQ(archive.resolve(1), 3U);
  EXPECT_EQ(archive.resolve(7), 7U);
  const auto landmarks = landmarksOf(archive);
  ASSERT_EQ(landmarks.size(), 1U);
  EXPECT_EQ(landmarks[0].merged_ids, (std::vector<LandmarkId>{1, 2}));
  for (const DetectionAssociation& association : archive.associations()) EXPECT_EQ(association.landmark, 3U);
}

TEST(SubmapArchiveTest, LandmarksOfALoopBecomeOneAndLaterSubmapsFollow) {
  SubmapArchive archive(0.5);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(1, 0.0, 0.9)}, {{0, 0, 1}}, {}));
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(5, 0.2, 0.7)}, {{1, 0, 5}}, {}));
  archive.merge(5, 1);
  ASSERT_EQ(landmarksOf(archive).size(), 1U);
  EXPECT_EQ(landmarksOf(archive)[0].id, 1U);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(5, 0.3, 0.8)}, {{2, 0, 5}}, {}));
  const auto landmarks = landmarksOf(archive);
  ASSERT_EQ(landmarks.size(), 1U) << "a mapper that still uses the old id makes no second landmark";
  EXPECT_EQ(landmarks[0].id, 1U);
  EXPECT_EQ(landmarks[0].merged_ids, std::vector<LandmarkId>{5});
  for (const DetectionAssociation& association : archive.associations()) EXPECT_EQ(association.landmark, 1U);
  archive.merge(5, 1);
  EXPECT_EQ(archive.resolve(5), 1U) << "merging twice is no circle";
}

std::vector<LandmarkId> idsOf(const SubmapArchive& archive, int submap) {
  std::vector<LandmarkId> ids;
  archive.forEachLandmarkOf(submap, [&](const MixtureLandmark& landmark) { ids.push_back(landmark.id); });
  return ids;
}

TEST(SubmapArchiveTest, ALandmarkBelongsToTheSubmapThatSawItLast) {
  SubmapArchive archive(0.5);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(1, 40.0, 0.9), makeLandmark(2, -7.0, 0.9)}, {}, {}));
  EXPECT_EQ(idsOf(archive, 0), (std::vector<LandmarkId>{1, 2}));
  EXPECT_EQ(archive.reach_m(0), 40.0);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(1, 5.0, 0.9), makeLandmark(6, 3.0, 0.2)}, {}, {}));
  EXPECT_EQ(idsOf(archive, 0), std::vector<LandmarkId>{2});
  EXPECT_EQ(idsOf(archive, 1), std::vector<LandmarkId>{1}) << "6 is not part of the map";
  archive.merge(2, 9);  // a survivor that no submap has
  EXPECT_EQ(idsOf(archive, 0), std::vector<LandmarkId>{9});
  archive.merge(9, 1);
  EXPECT_TRUE(idsOf(archive, 0).empty());
  EXPECT_EQ(idsOf(archive, 1), std::vector<LandmarkId>{1});
  ASSERT_EQ(landmarksOf(archive).size(), 1U);
}

TEST(SubmapArchiveTest, WrittenAndReadItHasTheSameLandmarksInTheSameSubmaps) {
  SubmapArchive archive(0.5);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(1, 4.0, 0.9), makeLandmark(2, -7.0, 0.9)}, {}, {}));
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(1, 5.0, 0.9), makeLandmark(3, 1.0, 0.7)}, {}, {}));
  archive.merge(3, 2);
  StateArchive writing;
  archive.transfer(writing);
  SubmapArchive other(0.5);
  other.add(makeSubmap(Pose::identity(), {makeLandmark(8, 4.0, 0.9)}, {}, {}));  // all of it goes
  StateArchive reading(writing.written());
  other.transfer(reading);
  for (const int submap : {0, 1}) EXPECT_EQ(idsOf(other, submap), idsOf(archive, submap));
  EXPECT_EQ(other.reach_m(1), 5.0);
  ASSERT_EQ(landmarksOf(other).size(), 2U);
  EXPECT_EQ(landmarksOf(other)[1].observations, landmarksOf(archive)[1].observations);
  EXPECT_EQ(other.resolve(3), 2U);
}

TEST(SubmapArchiveTest, DetectionsOfUnlikelyLandmarksAreFalsePositives) {
  SubmapArchive archive(0.5);
  archive.add(makeSubmap(Pose::identity(), {makeLandmark(1, 0.0, 0.2), makeLandmark(2, 5.0, 0.8)},
                         {{0, 0, 1}, {0, 1, 2}, {0, 2, kNoLandmark}}, {}));
  const auto associations = archive.associations();
  EXPECT_EQ(associations[0].landmark, kNoLandmark);
  EXPECT_EQ(associations[1].landmark, 2U);
  EXPECT_EQ(associations[2].landmark, kNoLandmark);
  EXPECT_EQ(landmarksOf(archive).size(), 1U);
}

}  // namespace
}  // namespace semantic_mht_slam
