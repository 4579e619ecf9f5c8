#include "semantic_mht_slam/ros/ambiguity_description.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/recordings.h"

namespace semantic_mht_slam {
namespace {

/// Stands between two poles that are hardly apart, and two detections that may be of either.
std::unique_ptr<Slam> seeTwoNearPoles(const ExplainLimits& limits) {
  auto result = std::make_unique<Slam>(SlamConfig{}, makeTwoClasses());
  Slam& slam = *result;
  slam.explain(limits);
  for (int i = 0; i < 60; ++i) {
    const Pose T_odom_base{Eigen::Quaterniond::Identity(), {0.4 * i, 0.0, 0.0}};
    Detections detections;
    for (const Eigen::Vector3d& pole_m : {Eigen::Vector3d(25.0, 5.0, 0.0), Eigen::Vector3d(25.0, 5.5, 0.0)}) {
      if (i % 5 == 4 && !detections.empty()) continue;
      detections.emplace_back();
      detections.back().position_m = T_odom_base.inverse() * pole_m;
      if (i % 5 == 4) detections.back().position_m.y() += 0.25;
      detections.back().row = static_cast<int>(detections.size()) - 1;
    }
    const Stamp stamp = (i + 1) * 100000000LL;
    slam.addOdometry({stamp, T_odom_base});
    slam.addDetections(stamp, detections);
  }
  slam.finish();
  return result;
}

TEST(AmbiguityDescriptionTest, TheMessageHasPlacesAndNamesOfTheMap) {
  const auto slam = seeTwoNearPoles({0.98, 100});
  std::vector<UnsureDetections> submaps = slam->takeUnsure();
  ASSERT_FALSE(submaps.empty());
  EXPECT_EQ(submaps.size(), slam->map().submaps().size());
  EXPECT_TRUE(slam->takeUnsure().empty()) << "each is taken once";
  std::size_t between = 0;
  for (const UnsureDetections& unsure : submaps) {
    const AmbiguousDetections message = toAmbiguousDetections(unsure, slam->map(), makeTwoClasses(), "map");
    EXPECT_EQ(message.header.frame_id, "map");
    EXPECT_EQ(message.submap, unsure.submap.index());
    EXPECT_GE(message.detections, message.ambiguous);
    EXPECT_EQ(message.ambiguous, message.items.size());
    for (const AmbiguousDetection& item : message.items) {
      EXPECT_EQ(item.class_id, 7U);
      EXPECT_LT(item.probability, 0.98);
      EXPECT_GT(item.clutter_density, 0.0);
      ASSERT_FALSE(item.alternatives.empty());
      if (item.alternatives.size() < 3 || std::abs(item.position.y - 5.25) > 0.12) continue;
      ++between;
      EXPECT_NEAR(item.position.x, 25.0, 0.2) << "in the map, not in the submap or the base";
      EXPECT_LT(item.alternatives[0].distance, 3.0);
      EXPECT_LT(item.alternatives[1].distance, 3.0);
    }
  }
  EXPECT_GT(between, 0U);
}

TEST(AmbiguityDescriptionTest, NothingIsKeptUnlessAskedFor) {
  EXPECT_TRUE(seeTwoNearPoles({})->takeUnsure().empty());
}

TEST(AmbiguityDescriptionTest, TheWordsSayWhatAndWhy) {
  SemanticMap map;
  map.classes.resize(1);
  map.classes[0].id = 7;
  map.classes[0].name = "pole";
  AmbiguousDetection detection;
  detection.class_id = 7;
  detection.position.x = 3.0;
  detection.landmark = 12;
  detection.probability = 0.625;
  detection.clutter_density = 1.2e-5;
  EXPECT_EQ(describeDetection(map, detection),
            (std::vector<std::string>{"pole at (3.0, 0.0) m, given to 12", "62.5 %", ""}));
  detection.landmark = 0;
  detection.moving_prob = 0.25;
  EXPECT_EQ(describeDetection(map, detection),
            (std::vector<std::string>{"pole at (3.0, 0.0) m, given to none", "62.5 %", "moves: 25.0 %"}));
  DetectionAlternative alternative;
  alternative.probability = 0.5;
  EXPECT_EQ(describeAlternative(detection, alternative),
            (std::vector<std::string>{"nothing: clutter of 1.2e-05 a m^3", "50.0 %"}));
  alternative.landmark = 12;
  alternative.distance = 2.0;
  alternative.log_place = 3.0;
  alternative.log_class = -0.5;
  alternative.log_expected = 1.5;
  alternative.observations = 8;
  alternative.log_count_prior = 2.1;
  EXPECT_EQ(describeAlternative(detection, alternative),
            (std::vector<std::string>{"landmark 12", "50.0 %", "2.0 sigma", "+3.0", "-0.5", "+1.5", "8 (+2.1)"}));
  EXPECT_EQ(ambiguityColumns().size(), 7U);
  AmbiguousDetections message;
  message.submap = 3;
  message.detections = 100;
  message.ambiguous = 5;
  message.below = 0.98;
  message.items.resize(2);
  EXPECT_EQ(summaryOf(message), "submap 3: 5 of 100 detections below 98.0 %, the 2 least sure");
}

}  // namespace
}  // namespace semantic_mht_slam
