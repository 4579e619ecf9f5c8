/// \file
/// Fixes of a real receiver: a tenth of them is used, the others say how far the map is off. Where there is the data.

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/evaluation/rigid_alignment.h"
#include "semantic_mht_slam/evaluation/statistics.h"
#include "semantic_mht_slam/io/csv_file.h"

namespace semantic_mht_slam {
namespace {

constexpr GeodeticPoint kInvented{-33.885, 151.19, 30.0};  // the file is in metres about a place that it does not name

struct PlanarFix {
  Stamp stamp = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

/// Distances that half and 95 % of the fixes do not exceed.
struct Distances {
  double median_m = 0.0;
  double most_m = 0.0;
};

Distances distancesOf(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b, const Pose& T_b_a) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < a.size(); ++i) distances.push_back((T_b_a * a[i] - b[i]).head<2>().norm());
  std::sort(distances.begin(), distances.end());
  return {median(distances), distances[distances.size() * 95 / 100]};
}

/// By the nine tenths that fit best.
Pose trimmedAlignment(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  Pose T_b_a = planarAlignment(a, b);
  for (int round = 0; round < 20; ++round) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < a.size(); ++i) distances.push_back((T_b_a * a[i] - b[i]).head<2>().norm());
    std::vector<double> sorted = distances;
    std::sort(sorted.begin(), sorted.end());
    const double most_m = sorted[sorted.size() * 9 / 10];
    std::vector<Eigen::Vector3d> near_a;
    std::vector<Eigen::Vector3d> near_b;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (distances[i] > most_m) continue;
      near_a.push_back(a[i]);
      near_b.push_back(b[i]);
    }
    T_b_a = planarAlignment(near_a, near_b);
  }
  return T_b_a;
}

class VictoriaParkFixesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("SEMANTIC_MHT_SLAM_DATA");
    if (data == nullptr || *data == '\0') GTEST_SKIP() << "needs SEMANTIC_MHT_SLAM_DATA";
    folder_ = std::string(data) + "/robots/victoria_park";
    config_ = makeSystemConfig({{"class_table", folder_ + "/classes.yaml", "test"}});
    classes_ = loadClassTable(config_, "");
    recording_ = toRecording(readDataset({folder_, "objects.csv", "odometry/odometry.txt", {}}, classes_));
    const std::string notice = CsvReader({"time", "x", "y"}).read(folder_ + "/gps.csv", [&](const CsvRow& row) {
      fixes_.push_back({stampFromSeconds(row.number(0)), {row.number(1), row.number(2), 0.0}});
    });
    ASSERT_EQ(notice, "");
  }

  RunResult run(bool uses_fixes, bool closes_loops) const {
    Recording recording = recording_;
    for (std::size_t i = 0; uses_fixes && i < fixes_.size(); i += 10) {
      GnssFix& fix = recording.fixes.emplace_back();
      fix.stamp = fixes_[i].stamp;
      fix.place = toGeodetic(kInvented, fixes_[i].position_m);
      fix.place.altitude_m = std::numeric_limits<double>::quiet_NaN();
    }
    SlamConfig config = config_.slam;
    config.back_end.close_loops = closes_loops;
    return runOffline(recording, config, classes_, [](std::size_t, std::size_t) {});
  }

  /// Where the map has the held-out fixes, and where they are.
  void heldOut(const RunResult& result, std::vector<Eigen::Vector3d>& in_map_m,
               std::vector<Eigen::Vector3d>& measured_m) const {
    auto after = result.trajectory.begin();
    for (std::size_t i = 0; i < fixes_.size(); ++i) {
      while (after != result.trajectory.end() && after->stamp < fixes_[i].stamp) ++after;
      if (i % 10 == 0 || after == result.trajectory.begin() || after == result.trajectory.end()) continue;
      const StampedPose& before = *std::prev(after);
      const double fraction =
          static_cast<double>(fixes_[i].stamp - before.stamp) / static_cast<double>(after->stamp - before.stamp);
      in_map_m.push_back(interpolate(before.T_world_base, after->T_world_base, fraction).translation_m);
      measured_m.push_back(fixes_[i].position_m);
    }
  }

  Distances aligned(const RunResult& result, const char* name) const {
    std::vector<Eigen::Vector3d> in_map_m;
    std::vector<Eigen::Vector3d> measured_m;
    heldOut(result, in_map_m, measured_m);
    const Distances distances = distancesOf(in_map_m, measured_m, trimmedAlignment(in_map_m, measured_m));
    std::printf("%s: %zu held-out fixes, aligned: median %.2f m, 95 %% %.2f m\n", name, in_map_m.size(),
                distances.median_m, distances.most_m);
    return distances;
  }

  Distances absolute(const RunResult& result) const {
    std::vector<Eigen::Vector3d> in_map_m;
    std::vector<Eigen::Vector3d> measured_m;
    heldOut(result, in_map_m, measured_m);
    for (Eigen::Vector3d& place_m : in_map_m) {
      const GeoReference& reference = *result.geo_reference;
      place_m = toEastNorthUp(kInvented, toGeodetic(reference.origin, reference.T_enu_map * place_m));
    }
    const Distances distances = distancesOf(in_map_m, measured_m, Pose::identity());
    std::printf("  as the map says itself: median %.2f m, 95 %% %.2f m\n", distances.median_m, distances.most_m);
    return distances;
  }

  std::string folder_;
  SystemConfig config_;
  ClassTable classes_;
  Recording recording_;
  std::vector<PlanarFix> fixes_;
};

TEST_F(VictoriaParkFixesTest, AMapThatClosesItsLoopsGetsItsPlaceAndIsNoWorse) {
  const Distances without = aligned(run(false, true), "without fixes");
  const RunResult result = run(true, true);
  const Distances with = aligned(result, "with a tenth of the fixes");
  ASSERT_TRUE(result.geo_reference);
  EXPECT_LT(with.median_m, 1.05 * without.median_m);
  EXPECT_LT(with.most_m, 1.05 * without.most_m);
  EXPECT_LT(absolute(result).median_m, 2.0);
}

TEST_F(VictoriaParkFixesTest, AMapWithoutLoopClosuresIsHeldByItsFixes) {
  const Distances without = aligned(run(false, false), "without fixes and closures");
  const RunResult result = run(true, false);
  const Distances with = aligned(result, "with a tenth of the fixes, without closures");
  ASSERT_TRUE(result.geo_reference);
  EXPECT_LT(with.median_m, without.median_m);
  absolute(result);
}

}  // namespace
}  // namespace semantic_mht_slam
