#include "semantic_mht_slam/mapping/unsure_detections.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mapping/mapper_test_util.h"

namespace semantic_mht_slam {
namespace {

struct Noted {
  UnsureDetections detections;
  int explained = 0;
};

Noted note(const std::vector<double>& probabilities, const ExplainLimits& limits) {
  UnsureSelection selection(limits);
  Noted noted;
  for (std::size_t i = 0; i < probabilities.size(); ++i) {
    selection.note(probabilities[i], [&] {
      ++noted.explained;
      UnsureDetection detection;
      detection.frame = i;
      detection.probability = probabilities[i];
      return detection;
    });
  }
  noted.detections = selection.take(SubmapId(4));
  return noted;
}

/// 25 m between poles 1.5 m apart that are seen within half a metre, with detections of nothing, 1 m a frame.
std::vector<Detections> drivePastPoles() {
  Rng rng(3);
  std::vector<Detections> frames(25);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto add = [&](const Eigen::Vector3d& position_m) {
      frames[f].emplace_back();
      frames[f].back().position_m = position_m;
      frames[f].back().row = static_cast<int>(frames[f].size()) - 1;
    };
    for (int i = 0; i < 25; ++i) {
      const double ahead_m = 1.5 * i - static_cast<double>(f);
      if (std::abs(ahead_m) < 20.0) add({ahead_m + rng.normal(0.0, 0.3), 6.0 + rng.normal(0.0, 0.3), 0.0});
    }
    for (int i = 0; i < 3; ++i) add({rng.uniform(-20.0, 20.0), rng.uniform(-20.0, 20.0), 0.0});
  }
  return frames;
}

TEST(UnsureSelectionTest, TheLeastSureOfThemStayInTheOrderOfTheirFrames) {
  const Noted noted = note({0.5, 0.99, 0.1, 0.7, 0.2, 0.98, 0.3}, {0.98, 3});
  EXPECT_EQ(noted.detections.submap, SubmapId(4));
  EXPECT_EQ(noted.detections.detections, 7U);
  EXPECT_EQ(noted.detections.unsure, 5U) << "those below 0.98";
  ASSERT_EQ(noted.detections.items.size(), 3U);
  EXPECT_EQ(noted.detections.items[0].frame, 2U);
  EXPECT_EQ(noted.detections.items[1].frame, 4U);
  EXPECT_EQ(noted.detections.items[2].frame, 6U);
}

TEST(UnsureSelectionTest, OfEqualOnesTheFirstStay) {
  const Noted noted = note(std::vector<double>(1000, 0.5), {0.98, 2});
  ASSERT_EQ(noted.detections.items.size(), 2U);
  EXPECT_EQ(noted.detections.items[0].frame, 0U);
  EXPECT_EQ(noted.detections.items[1].frame, 1U);
  EXPECT_EQ(noted.explained, 2) << "what is not picked is not explained";
}

TEST(UnsureSelectionTest, NothingIsExplainedUnlessAskedFor) {
  EXPECT_EQ(note({0.0, 0.5, 1.0}, {}).explained, 0);
  EXPECT_EQ(note({0.0, 0.5, 1.0}, {0.98, 0}).explained, 0);
}

TEST(UnsureDetectionsTest, WhatIsUnsureIsExplainedIfAskedForAndChangesNothing) {
  const std::vector<Detections> frames = drivePastPoles();
  std::vector<FinishedSubmap> finished;
  for (const ExplainLimits& limits : {ExplainLimits{}, ExplainLimits{0.98, 40}}) {
    ClassInfo pole;
    pole.name = "pole";
    Mapper mapper({}, ClassTable({pole}, "test"));
    Rng rng(1);
    for (std::size_t f = 0; f < 25; ++f) {
      const Pose T_odom_base{Eigen::Quaterniond::Identity(), {static_cast<double>(f), 0.0, 0.0}};
      feed(mapper, {f, static_cast<Stamp>(f), T_odom_base, frames[f]}, rng);
    }
    finished.push_back(mapper.finish(limits));
  }
  EXPECT_TRUE(finished[0].unsure.items.empty());
  const UnsureDetections& unsure = finished[1].unsure;
  const std::vector<DetectionAssociation>& associations = finished[1].submap.associations;
  ASSERT_EQ(associations.size(), finished[0].submap.associations.size());
  std::size_t below = 0;
  for (std::size_t i = 0; i < associations.size(); ++i) {
    EXPECT_EQ(associations[i].landmark, finished[0].submap.associations[i].landmark);
    EXPECT_EQ(associations[i].probability, finished[0].submap.associations[i].probability);
    if (associations[i].probability < 0.98) ++below;
  }
  EXPECT_EQ(unsure.detections, associations.size());
  EXPECT_EQ(unsure.unsure, below);
  ASSERT_EQ(unsure.items.size(), std::min<std::size_t>(below, 40));
  for (const UnsureDetection& detection : unsure.items) {
    double sum = 0.0;
    for (const AssociationAlternative& alternative : detection.alternatives) sum += alternative.probability;
    EXPECT_NEAR(sum, 1.0, 0.01) << "but for those that are left out";
    const Eigen::Vector3d detected_m = frames[detection.frame][static_cast<std::size_t>(detection.row)].position_m;
    EXPECT_NEAR(detection.position_m.x(), detected_m.x() + static_cast<double>(detection.frame), 1.0);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
