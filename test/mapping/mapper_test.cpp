#include "semantic_mht_slam/mapping/mapper.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "mapping/mapper_test_util.h"

namespace semantic_mht_slam {
namespace {

constexpr int kFrames = 80;

ClassTable makeTable() {
  std::vector<ClassInfo> classes(2);
  classes[0].name = "pole";
  classes[1].name = "trunk";
  classes[1].id = 1;
  return ClassTable(classes, "test");
}

struct Seen {
  Detections detections;
  std::vector<int> truth;
};

/// A straight drive of 80 m between poles 6 m apart on both sides, every object within 25 m seen with probability
/// `seen_prob`.
std::vector<Seen> simulate(std::uint64_t seed, double noise_m, double clutter_per_frame, double seen_prob = 0.8) {
  Rng rng(seed);
  std::vector<Eigen::Vector3d> objects;
  for (int i = -3; i < 20; ++i) {
    for (const double side : {-7.0, 7.0})
      objects.push_back({6.0 * i + rng.uniform(-1.0, 1.0), side, rng.uniform(-0.5, 0.5)});
  }
  std::vector<Seen> frames(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    Seen& seen = frames[static_cast<std::size_t>(f)];
    const auto add = [&](const Eigen::Vector3d& position_m, ClassIndex class_index, int truth) {
      Detection detection;
      detection.position_m = position_m;
      detection.class_index = class_index;
      detection.row = static_cast<int>(seen.detections.size());
      seen.detections.push_back(detection);
      seen.truth.push_back(truth);
    };
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Eigen::Vector3d relative = objects[i] - Eigen::Vector3d(f, 0.0, 0.0);
      if (relative.norm() > 25.0 || !rng.bernoulli(seen_prob)) continue;
      const Eigen::Vector3d noise(rng.normal(0.0, noise_m), rng.normal(0.0, noise_m), rng.normal(0.0, noise_m));
      add(relative + noise, static_cast<ClassIndex>(i % 2), static_cast<int>(i));
    }
    for (std::uint64_t n = rng.poisson(clutter_per_frame); n > 0; --n) {
      add({rng.uniform(-25.0, 25.0), rng.uniform(-25.0, 25.0), 0.0}, static_cast<ClassIndex>(rng.index(2)), -1);
    }
  }
  return frames;
}

struct MapperRun {
  std::vector<Submap> submaps;
  std::size_t most_hypotheses = 0;
  double largest_weight_error = 0.0;
};

MapperRun runMapper(const MapperConfig& config, const std::vector<Seen>& frames, std::uint64_t seed = 1) {
  Mapper mapper(config, makeTable());
  Rng rng(seed);
  MapperRun run;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Pose T_odom_base{Eigen::Quaterniond::Identity(), {static_cast<double>(f), 0.0, 0.0}};
    const auto finished = feed(mapper, {f, static_cast<Stamp>(f), T_odom_base, frames[f].detections}, rng);
    if (finished) run.submaps.push_back(finished->submap);
    double sum = 0.0;
    for (const MapHypothesis& hypothesis : mapper.hypotheses()) sum += std::exp(hypothesis.log_weight);
    run.largest_weight_error = std::max(run.largest_weight_error, std::abs(sum - 1.0));
    run.most_hypotheses = std::max(run.most_hypotheses, mapper.hypotheses().size());
  }
  run.submaps.push_back(mapper.finish().submap);
  return run;
}

/// Ids by (frame, row).
std::map<std::pair<std::size_t, int>, LandmarkId> idsOf(const MapperRun& run) {
  std::map<std::pair<std::size_t, int>, LandmarkId> ids;
  for (const Submap& submap : run.submaps) {
    for (const auto& association : submap.associations)
      ids[{association.frame, association.row}] = association.landmark;
  }
  return ids;
}

/// Share of the detections of an object that have the id most of them have.
double purity(const MapperRun& run, const std::vector<Seen>& frames) {
  const auto ids = idsOf(run);
  std::map<int, std::map<LandmarkId, int>> counts;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t row = 0; row < frames[f].truth.size(); ++row) {
      if (frames[f].truth[row] >= 0) ++counts[frames[f].truth[row]][ids.at({f, static_cast<int>(row)})];
    }
  }
  int right = 0;
  int all = 0;
  for (const auto& [truth, by_id] : counts) {
    int most = 0;
    for (const auto& [id, count] : by_id) {
      all += count;
      if (id != kNoLandmark) most = std::max(most, count);
    }
    right += most;
  }
  return static_cast<double>(right) / all;
}

TEST(MapperTest, SubmapsHaveTheirLengthAndEveryDetectionOneAssociation) {
  const std::vector<Seen> frames = simulate(1, 0.05, 1.0);
  const MapperRun run = runMapper({}, frames);
  EXPECT_EQ(run.submaps.size(), 3U) << "80 m in submaps of 30 m";
  std::size_t detections = 0;
  for (const Seen& seen : frames) detections += seen.detections.size();
  EXPECT_EQ(idsOf(run).size(), detections);
}

TEST(MapperTest, IdsStayTheSameAcrossSubmaps) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<Seen> frames = simulate(seed, 0.05, 0.0);
    EXPECT_GT(purity(runMapper({}, frames), frames), 0.99) << "seed " << seed;
  }
}

TEST(MapperTest, WeightsSumToOneAndTheCapHolds) {
  MapperConfig config;
  config.tree.max_hypotheses = 6;
  config.tree.min_weight = 0.0;
  const MapperRun run = runMapper(config, simulate(2, 0.8, 4.0));
  EXPECT_LT(run.largest_weight_error, 1e-9);
  EXPECT_GT(run.most_hypotheses, 1U) << "the scene is meant to be ambiguous";
  EXPECT_LE(run.most_hypotheses, 6U);
}

TEST(MapperTest, OrderOfDetectionsDoesNotChangeTheResult) {
  const std::vector<Seen> frames = simulate(3, 0.3, 1.0);
  std::vector<Seen> shuffled = frames;
  Rng rng(9);
  for (Seen& seen : shuffled) {
    for (std::size_t i = seen.detections.size(); i > 1; --i) {
      std::swap(seen.detections[i - 1], seen.detections[rng.index(i)]);
    }
  }
  const auto ids = idsOf(runMapper({}, frames));
  const auto shuffled_ids = idsOf(runMapper({}, shuffled));
  ASSERT_EQ(ids.size(), shuffled_ids.size());
  std::map<LandmarkId, LandmarkId> name_of;  // ids are given in the order of detections; the partition must be the same
  for (const auto& [key, id] : ids) {
    const auto [known, is_new] = name_of.emplace(id, shuffled_ids.at(key));
    EXPECT_EQ(known->second, shuffled_ids.at(key)) << "frame " << key.first << " row " << key.second;
  }
}

TEST(MapperTest, SameSeedGivesTheSameResult) {
  const std::vector<Seen> frames = simulate(4, 0.6, 3.0);
  EXPECT_EQ(idsOf(runMapper({}, frames, 7)), idsOf(runMapper({}, frames, 7)));
}

/// The configuration of somebody who knows the odometry.
MapperConfig withKnownOdometry(MapperConfig config) {
  config.odometry.learn = false;
  config.odometry.noise = {0.045, 0.045, 0.045, 0.0007, 0.0007, 0.0007};
  return config;
}

TEST(MapperTest, InAnUnambiguousWorldEveryMethodGivesTheSamePartition) {
  const std::vector<Seen> frames = simulate(5, 0.02, 0.0, 1.0);
  const auto reference = idsOf(runMapper(defaultsOf(Estimator::kUkf), frames));
  MapperConfig single;
  single.tree.max_hypotheses = 1;
  for (const MapperConfig& config : {MapperConfig{}, single, defaultsOf(Estimator::kMhm)}) {
    EXPECT_EQ(idsOf(runMapper(withKnownOdometry(config), frames)), reference);
  }
}

TEST(MapperTest, ClutterHardlyGetsIntoTheMapAndObjectsDo) {
  const std::vector<Seen> frames = simulate(6, 0.1, 2.0);
  const MapperRun run = runMapper({}, frames);
  std::map<LandmarkId, double> existence;
  for (const Submap& submap : run.submaps) {
    for (const MixtureLandmark& landmark : submap.landmarks) existence[landmark.id] = landmark.existence_prob;
  }
  int clutter = 0;
  int clutter_kept = 0;
  int objects = 0;
  int objects_kept = 0;
  const auto ids = idsOf(run);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t row = 0; row < frames[f].truth.size(); ++row) {
      const bool is_kept = existence[ids.at({f, static_cast<int>(row)})] >= 0.5;
      const bool is_clutter = frames[f].truth[row] < 0;
      ++(is_clutter ? clutter : objects);
      if (is_kept) ++(is_clutter ? clutter_kept : objects_kept);
    }
  }
  EXPECT_LT(clutter_kept, 0.1 * clutter);
  EXPECT_GT(objects_kept, 0.97 * objects);
}

TEST(MapperTest, CorrectingThePoseRemovesDriftThatDetectionsShare) {
  std::vector<Seen> frames = simulate(7, 0.03, 0.0);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    // the odometry is 8 % too short: everything seems to move past faster
    for (Detection& detection : frames[f].detections) detection.position_m.x() -= 0.08 * static_cast<double>(f);
  }
  MapperConfig correcting = withKnownOdometry({});
  correcting.calibration.enabled = false;  // which would take the drift for noise
  MapperConfig uncorrected = correcting;
  uncorrected.submap.correct_pose = false;
  EXPECT_GT(purity(runMapper(correcting, frames), frames), 0.98);
  EXPECT_LT(purity(runMapper(uncorrected, frames), frames), 0.9);
}

TEST(MapperTest, CalibratedDetectionsStateTheNoiseThatWasLearnedNotThatOfTheTable) {
  Mapper mapper(MapperConfig{}, makeTable());
  Rng rng(3);
  const std::vector<Seen> frames = simulate(21, 0.4, 0.0);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Pose T_odom_base{Eigen::Quaterniond::Identity(), {static_cast<double>(f), 0.0, 0.0}};
    feed(mapper, {f, static_cast<Stamp>(f), T_odom_base, frames[f].detections}, rng);
  }
  const Detections calibrated = mapper.calibrated(frames.back().detections);
  ASSERT_FALSE(calibrated.empty());
  for (const Detection& detection : calibrated) {
    ASSERT_TRUE(detection.cov_m2);
    EXPECT_GT(std::sqrt(detection.cov_m2->trace() / 3.0), 0.2) << "0.4 m in truth, 0.1 m in the table";
  }
}

TEST(MapperTest, FramesWithoutAndWithTwoThousandDetectionsAreTaken) {
  std::vector<Seen> frames = simulate(8, 0.1, 0.0);
  frames[10].detections.clear();
  frames[10].truth.clear();
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    Detection detection;
    detection.position_m = {rng.uniform(-40.0, 40.0), rng.uniform(-40.0, 40.0), 0.0};
    detection.row = static_cast<int>(frames[20].detections.size());
    frames[20].detections.push_back(detection);
    frames[20].truth.push_back(-1);
  }
  EXPECT_EQ(runMapper({}, frames).submaps.size(), 3U);
}

TEST(MapperTest, RangeBearingModelIsUsedAndAgreesWithTheAdditiveOneInAnUnambiguousWorld) {
  const auto frames = simulate(6, 0.03, 0.0);
  MapperConfig config;
  config.bias.enabled = false;
  const MapperRun additive = runMapper(config, frames);
  config.measurement_model = MeasurementModel::kRangeBearing;
  const MapperRun polar = runMapper(config, frames);
  ASSERT_EQ(additive.submaps.size(), polar.submaps.size());
  double largest_m = 0.0;
  for (std::size_t s = 0; s < polar.submaps.size(); ++s) {
    const auto& a = additive.submaps[s];
    const auto& b = polar.submaps[s];
    ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
    for (std::size_t i = 0; i < a.associations.size(); ++i) {
      EXPECT_EQ(a.associations[i].landmark, b.associations[i].landmark);
    }
    for (std::size_t j = 0; j < a.landmarks.size(); ++j) {
      largest_m = std::max(largest_m, (a.landmarks[j].position.mean_m - b.landmarks[j].position.mean_m).norm());
    }
  }
  EXPECT_GT(largest_m, 1e-9);
  EXPECT_LT(largest_m, 0.05);
}

TEST(MapperTest, WhatTheDetectorSaysMovesIsLeftOutAndCounted) {
  Mapper mapper(MapperConfig(), makeTable());
  Rng rng(1);
  for (std::size_t f = 0; f < 5; ++f) {
    Detections detections(2);
    detections[0].position_m = {10.0, 5.0, 0.0};
    detections[0].is_moving = true;
    detections[1].position_m = {10.0, -5.0, 0.0};
    detections[1].row = 1;
    feed(mapper, {f, static_cast<Stamp>(f), Pose::identity(), detections}, rng);
  }
  const FinishedSubmap finished = mapper.finish();
  EXPECT_EQ(mapper.movingCounts().flagged, 5U);
  ASSERT_EQ(finished.submap.associations.size(), 10U);
  for (const DetectionAssociation& association : finished.submap.associations) {
    EXPECT_EQ(association.landmark == kNoLandmark, association.row == 0);
  }
  EXPECT_EQ(finished.submap.landmarks.size(), 1U);
}

}  // namespace
}  // namespace semantic_mht_slam
