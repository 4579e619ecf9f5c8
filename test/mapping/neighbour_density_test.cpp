#include "semantic_mht_slam/mapping/neighbour_density.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr double kReach_m = 6.0;
const SubmapId kSubmap(0);

MixtureLandmark makeChair(LandmarkId id, double x_m, double existence_prob = 1.0, ClassIndex class_index = 0) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position.mean_m = {x_m, 0.0, 0.0};
  landmark.class_probs = ClassProbs::Zero(2);
  landmark.class_probs[class_index] = 1.0;
  landmark.existence_prob = existence_prob;
  landmark.first_submap = landmark.last_submap = kSubmap;
  return landmark;
}

/// Pairs that stand `distance_m` apart, each far from all others.
std::vector<MixtureLandmark> makePairs(int count, double distance_m, double existence_prob = 1.0) {
  std::vector<MixtureLandmark> landmarks;
  for (int i = 0; i < count; ++i) {
    landmarks.push_back(makeChair(2 * i + 1, 100.0 * i));
    landmarks.push_back(makeChair(2 * i + 2, 100.0 * i + distance_m, existence_prob));
  }
  return landmarks;
}

double densityAt(const NeighbourDensity& neighbours, double distance_m, double height_m = 0.0) {
  return std::exp(neighbours.logDensity(0, {0.0, distance_m, height_m}));
}

TEST(NeighbourDensityTest, WhereNoneWasSeenThereIsNone) {
  NeighbourDensity neighbours(2, kReach_m);
  EXPECT_EQ(densityAt(neighbours, 0.5), 0.0);
  neighbours.add(kSubmap, makePairs(10, 2.0), {});
  EXPECT_EQ(densityAt(neighbours, 0.5), 0.0);
  EXPECT_GT(densityAt(neighbours, 2.0), 0.0);
  EXPECT_EQ(neighbours.logDensity(1, {2.0, 0.0, 0.0}), -std::numeric_limits<double>::infinity());
}

TEST(NeighbourDensityTest, IntegratesToTheNumberOfNeighbours) {
  NeighbourDensity neighbours(2, kReach_m);
  neighbours.add(kSubmap, makePairs(10, 0.5), {});
  double sum = 0.0;
  constexpr double kStep_m = 0.01;
  for (double r_m = 0.5 * kStep_m; r_m < 3.0; r_m += kStep_m) {
    for (double z_m = -0.5; z_m < 0.5; z_m += kStep_m) {
      sum += 2.0 * M_PI * r_m * kStep_m * kStep_m * densityAt(neighbours, r_m, z_m);
    }
  }
  EXPECT_NEAR(sum, 1.0, 0.05);
}

TEST(NeighbourDensityTest, CountsWhatExists) {
  NeighbourDensity sure(2, kReach_m);
  NeighbourDensity doubtful(2, kReach_m);
  sure.add(kSubmap, makePairs(10, 0.5), {});
  doubtful.add(kSubmap, makePairs(10, 0.5, 0.1), {});
  EXPECT_NEAR(densityAt(doubtful, 0.5) / densityAt(sure, 0.5), 0.1 * 20.0 / 11.0, 1e-9);
}

TEST(NeighbourDensityTest, ObjectsOfAnotherClassAreNoNeighbours) {
  NeighbourDensity neighbours(2, kReach_m);
  neighbours.add(kSubmap, {makeChair(1, 0.0), makeChair(2, 0.5, 1.0, 1)}, {});
  EXPECT_EQ(densityAt(neighbours, 0.5), 0.0);
}

TEST(NeighbourDensityTest, AtFirstEveryProbabilityOfDetectionIsAsLikely) {
  const NeighbourDensity neighbours(2, kReach_m);
  EXPECT_NEAR(neighbours.logFirstProb(0, 0), std::log(1.0 / 2.0), 1e-12);
  EXPECT_NEAR(neighbours.logFirstProb(0, 9), std::log(1.0 / 110.0), 1e-12);
}

/// After submaps in which the other of each pair came `looks` frames after the first one.
NeighbourDensity learnedFrom(int submaps, std::size_t looks) {
  NeighbourDensity neighbours(2, kReach_m);
  std::vector<MixtureLandmark> pair = makePairs(1, 0.5);
  pair[0].observations = 40;
  pair[1].observations = 40 - static_cast<int>(looks);
  std::vector<DetectionAssociation> associations;
  for (std::size_t frame = 0; frame < 40; ++frame) {
    associations.push_back({frame, 0, pair[0].id});
    if (frame >= looks) associations.push_back({frame, 1, pair[1].id});
  }
  for (int i = 0; i < submaps; ++i) neighbours.add(kSubmap, pair, associations);
  return neighbours;
}

TEST(NeighbourDensityTest, LearnsAfterHowManyLooksNeighboursAreSeen) {
  const NeighbourDensity soon = learnedFrom(20, 2);
  const NeighbourDensity late = learnedFrom(20, 20);
  EXPECT_GT(soon.logFirstProb(0, 2), late.logFirstProb(0, 2));
  EXPECT_LT(soon.logFirstProb(0, 20), late.logFirstProb(0, 20));
  EXPECT_NEAR(std::exp(late.logFirstProb(0, 20)), 1.0 / 6.0, 0.03) << "one in the looks 15 to 20";
}

}  // namespace
}  // namespace semantic_mht_slam
