#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/slam/slam.h"

#include "support/recordings.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMapShare = 0.6;
constexpr double kNear_m = 4.0;  // a place that the map shows
constexpr double kFindWithin_m = 50.0;
constexpr double kTrack_m = 200.0;
constexpr double kWrongPlace_m = 5.0;
constexpr std::size_t kPlaces = 20;

SystemConfig kittiConfig() {
  SystemConfig config = loadSystemConfig(packageConfigFile("kitti.yaml"), {});
  config.slam = loadableSlamConfig(config, "");
  return config;
}

/// What became of one start.
struct Trial {
  bool is_found = false;
  double found_after_m = 0.0;
  double first_error_m = 0.0;
  std::vector<double> errors_m;  ///< after the first fix, at every frame that the map shows
};

/// A map of the first part of a sequence, and what the rest has to do with it.
class Revisits {
 public:
  explicit Revisits(const std::string& folder)
      : config_(kittiConfig()),
        classes_(loadClassTable(config_, "")),
        recording_(toRecording(readDataset(filesOf(folder), classes_))),
        split_(static_cast<std::size_t>(kMapShare * static_cast<double>(recording_.odometry.size()))) {
    Slam slam(config_.slam, classes_);
    for (std::size_t i = 0; i < split_; ++i) feed(slam, i, Pose::identity());
    slam.finish();
    map_trajectory_ = trajectoryOf(slam);
    state_ = slam.snapshot();
    for (std::size_t i = 0; i < recording_.odometry.size(); ++i) nearest_.push_back(i < split_ ? i : nearestInMap(i));
  }

  /// Starts evenly spread over the places of the rest from where the map is near for `kFindWithin_m`.
  std::vector<std::size_t> starts() const {
    std::vector<std::size_t> possible;
    for (std::size_t i = split_; i < nearest_.size(); ++i) {
      std::size_t k = i;
      while (k < nearest_.size() && isNear(k) && driven(i, k) < kFindWithin_m) ++k;
      if (k < nearest_.size() && isNear(k)) possible.push_back(i);
    }
    std::vector<std::size_t> result;
    for (std::size_t n = 0; n < kPlaces; ++n) result.push_back(possible.at(n * (possible.size() - 1) / (kPlaces - 1)));
    return result;
  }

  /// Starts lost at a frame, in an odometry of its own.
  Trial run(std::size_t start) const {
    Trial trial;
    Slam slam(config_.slam, classes_, state_);
    slam.localize();
    slam.beginSession();
    const Pose T_session_odom = recording_.odometry[start].T_world_base.inverse();
    for (std::size_t i = start; i < nearest_.size(); ++i) {
      const double driven_m = driven(start, i);
      if (driven_m > (trial.is_found ? kTrack_m : kFindWithin_m) || !isNear(i)) break;
      feed(slam, i, T_session_odom);
      if (!isLocated(slam.mode())) continue;
      const double error_m = errorOf(latestPoseOf(slam)->T_world_base, i);
      if (!trial.is_found) {
        trial.found_after_m = driven_m;
        trial.first_error_m = error_m;
      }
      trial.is_found = true;
      trial.errors_m.push_back(error_m);
    }
    return trial;
  }

 private:
  static DatasetFiles filesOf(const std::string& folder) {
    DatasetFiles files;
    files.folder = folder;
    return files;
  }

  void feed(Slam& slam, std::size_t i, const Pose& T_session_odom) const {
    const StampedPose& odometry = recording_.odometry[i];
    slam.addOdometry({odometry.stamp, T_session_odom * odometry.T_world_base});
    slam.addDetections(odometry.stamp, recording_.detector_frames[i].detections);
  }

  const Pose& truth(std::size_t i) const { return recording_.ground_truth[i].T_world_base; }

  std::size_t nearestInMap(std::size_t i) const {
    std::size_t best = 0;
    for (std::size_t k = 0; k < split_; ++k) {
      if (distance(i, k) < distance(i, best)) best = k;
    }
    return best;
  }

  double distance(std::size_t i, std::size_t k) const {
    return (truth(i).translation_m - truth(k).translation_m).norm();
  }

  bool isNear(std::size_t i) const { return distance(i, nearest_[i]) < kNear_m; }

  double driven(std::size_t from, std::size_t to) const {
    double sum_m = 0.0;
    for (std::size_t i = from; i < to; ++i) sum_m += distance(i, i + 1);
    return sum_m;
  }

  /// Horizontal error relative to the map: against where the map puts the nearest pose of the first part, plus what the
  /// truth says of the way from there.
  double errorOf(const Pose& T_map_base, std::size_t i) const {
    const std::size_t k = nearest_[i];
    const Pose expected = map_trajectory_[k].T_world_base * truth(k).inverse() * truth(i);
    return (T_map_base.translation_m - expected.translation_m).head<2>().norm();
  }

  SystemConfig config_;
  ClassTable classes_;
  Recording recording_;
  std::size_t split_;
  std::vector<StampedPose> map_trajectory_;
  SlamState state_;
  std::vector<std::size_t> nearest_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? std::numeric_limits<double>::infinity() : values[values.size() / 2];
}

TEST(LocalizationTest, LostVehiclesFindThemselvesInTheMapOfKitti00) {
  const auto folder = kittiFolder("00");
  if (!folder) GTEST_SKIP() << "no KITTI data";
  const Revisits revisits(*folder);
  int found = 0;
  int wrong = 0;
  std::vector<double> errors_m;
  for (const std::size_t start : revisits.starts()) {
    const Trial trial = revisits.run(start);
    found += trial.is_found ? 1 : 0;
    wrong += trial.is_found && trial.first_error_m > kWrongPlace_m ? 1 : 0;
    errors_m.insert(errors_m.end(), trial.errors_m.begin(), trial.errors_m.end());
    std::printf("frame %zu: %s after %.1f m, first error %.2f m, median %.2f m over %zu frames\n", start,
                trial.is_found ? "found" : "not found", trial.found_after_m, trial.first_error_m,
                median(trial.errors_m), trial.errors_m.size());
  }
  std::sort(errors_m.begin(), errors_m.end());
  std::printf("%d of %zu found, %d at a wrong place; error median %.3f m, 90 %% %.3f m\n", found, kPlaces, wrong,
              median(errors_m), errors_m.empty() ? 0.0 : errors_m[errors_m.size() * 9 / 10]);
  EXPECT_GE(found, 18);
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(median(errors_m), 0.5);
}

TEST(SnapshotTest, GoingOnWithKitti00EqualsNeverHavingStopped) {
  const auto folder = kittiFolder("00");
  if (!folder) GTEST_SKIP() << "no KITTI data";
  const SystemConfig config = kittiConfig();
  const ClassTable classes = loadClassTable(config, "");
  DatasetFiles files;
  files.folder = *folder;
  const Recording recording = toRecording(readDataset(files, classes));
  const auto feed = [&](Slam& slam, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      slam.addOdometry(recording.odometry[i]);
      slam.addDetections(recording.odometry[i].stamp, recording.detector_frames[i].detections);
    }
  };
  const std::size_t count = recording.odometry.size();
  Slam whole(config.slam, classes);
  feed(whole, 0, count);
  whole.finish();
  Slam first(config.slam, classes);
  feed(first, 0, count / 2);
  Slam second(config.slam, classes, first.snapshot());
  feed(second, count / 2, count);
  second.finish();
  const std::vector<StampedPose> expected = trajectoryOf(whole);
  const std::vector<StampedPose> trajectory = trajectoryOf(second);
  ASSERT_EQ(trajectory.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(trajectory[i].T_world_base.matrix(), expected[i].T_world_base.matrix()) << i;
  }
}

}  // namespace
}  // namespace semantic_mht_slam
