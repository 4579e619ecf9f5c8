#include "train_submap_evaluator_drives.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/simulated_dataset.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/simulation/simulator.h"

namespace semantic_mht_slam {
namespace {

// A loop needs a drive in between: standing still at a crossing is none.
constexpr double kMinLoop_m = 50.0;

std::vector<double> drivenLengths(const std::vector<Pose>& T_map_base) {
  std::vector<double> driven_m(T_map_base.size(), 0.0);
  for (std::size_t i = 1; i < T_map_base.size(); ++i) {
    driven_m[i] = driven_m[i - 1] + (T_map_base[i].translation_m - T_map_base[i - 1].translation_m).norm();
  }
  return driven_m;
}

// For each frame, the earlier frames at its place.
std::vector<std::vector<int>> findRevisits(const std::vector<Pose>& T_map_base) {
  const std::vector<double> driven_m = drivenLengths(T_map_base);
  std::vector<std::vector<int>> earlier(T_map_base.size());
  for (const auto& [i, j] : findLoopPairs(T_map_base)) {
    if (driven_m[i] - driven_m[j] >= kMinLoop_m) earlier[i].push_back(j);
  }
  return earlier;
}

std::unique_ptr<Slam> runSlam(const Recording& recording, const SlamConfig& config, const ClassTable& classes) {
  auto slam = std::make_unique<Slam>(config, classes);
  auto frame = recording.detector_frames.begin();
  for (const StampedPose& T_odom_base : recording.odometry) {
    slam->addOdometry(T_odom_base);
    for (; frame != recording.detector_frames.end() && frame->stamp <= T_odom_base.stamp; ++frame) {
      slam->addDetections(frame->stamp, frame->detections);
    }
  }
  slam->finish();
  return slam;
}

// A finished submap with its frames and what of it stays where it is, by the true pose of its first frame.
struct TrueSubmap {
  std::vector<std::size_t> frames;
  std::vector<MixtureLandmark> landmarks;  ///< true map frame
};

TrueSubmap toTrueSubmap(const Submap& submap, const Dataset& dataset, const ClassTable& classes) {
  TrueSubmap result;
  for (std::size_t i = 0; i < dataset.stamps.size(); ++i) {
    if (dataset.stamps[i] >= submap.begin && dataset.stamps[i] <= submap.end) result.frames.push_back(i);
  }
  if (result.frames.empty()) return result;
  const Pose& T_map_submap = (*dataset.T_map_base)[result.frames.front()];
  for (const MixtureLandmark& landmark : submap.landmarks) {
    if (landmark.existence_prob < 0.5 || !classes[landmark.mostLikelyClass()].is_static) continue;
    result.landmarks.push_back(transformed(T_map_submap, landmark));
  }
  return result;
}

bool isIn(const MixtureLandmark& landmark, const std::vector<MixtureLandmark>& landmarks) {
  constexpr double kMaxDistance_m = 1.0;
  return std::any_of(landmarks.begin(), landmarks.end(), [&](const MixtureLandmark& other) {
    const Eigen::Vector3d offset_m = landmark.position.mean_m - other.position.mean_m;
    return other.mostLikelyClass() == landmark.mostLikelyClass() && offset_m.head<2>().norm() < kMaxDistance_m;
  });
}

bool shareLandmarks(const TrueSubmap& a, const TrueSubmap& b) {
  const auto common = std::count_if(a.landmarks.begin(), a.landmarks.end(),
                                    [&](const MixtureLandmark& landmark) { return isIn(landmark, b.landmarks); });
  return common >= kMinCommonLandmarks;
}

// The submaps before `index` with a frame at a place of it.
std::set<std::size_t> revisitedSubmaps(const std::vector<TrueSubmap>& submaps, std::size_t index,
                                       const std::vector<std::vector<int>>& earlier) {
  std::set<int> frames;
  for (const std::size_t i : submaps[index].frames) frames.insert(earlier[i].begin(), earlier[i].end());
  std::set<std::size_t> revisited;
  for (std::size_t k = 0; k < index; ++k) {
    if (submaps[k].frames.empty()) continue;
    const auto first = frames.lower_bound(static_cast<int>(submaps[k].frames.front()));
    if (first != frames.end() && *first <= static_cast<int>(submaps[k].frames.back())) revisited.insert(k);
  }
  return revisited;
}

LabelledDrive labelledDrive(const std::string& name, const Dataset& dataset, const SlamConfig& config,
                            const ClassTable& classes) {
  const auto earlier = findRevisits(*dataset.T_map_base);
  const std::unique_ptr<Slam> slam = runSlam(toRecording(dataset), config, classes);
  LabelledDrive drive{name, {}};
  SubmapFeatureExtractor extractor(classes.size());
  std::vector<TrueSubmap> submaps;
  for (const auto& submap : slam->map().submaps()) {
    submaps.push_back(toTrueSubmap(*submap, dataset, classes));
    const auto revisited = revisitedSubmaps(submaps, submaps.size() - 1, earlier);
    const bool is_good = std::any_of(revisited.begin(), revisited.end(),
                                     [&](std::size_t k) { return shareLandmarks(submaps.back(), submaps[k]); });
    drive.submaps.push_back({extractor.add(*submap), !revisited.empty(), is_good});
  }
  return drive;
}

}  // namespace

LabelledDrive simulateLabelledDrive(const std::string& scenario, std::uint64_t seed, const SlamConfig& config,
                                    const ClassTable& classes) {
  const SimulatedDrive drive = simulateDrive(loadScenario(scenario), classes, seed);
  Dataset dataset;
  dataset.stamps = drive.stamps;
  dataset.T_cam0_base = drive.T_cam0_base;
  dataset.T_odom_base = drive.T_odom_base;
  dataset.detections = drive.detections;
  dataset.T_map_base = drive.T_map_base;
  const std::string name = std::filesystem::path(scenario).stem().string() + " " + std::to_string(seed);
  return labelledDrive(name, dataset, config, classes);
}

LabelledDrive readLabelledDrive(const DatasetFiles& files, const SlamConfig& config, const ClassTable& classes) {
  const Dataset dataset = readDataset(files, classes);
  if (!dataset.T_map_base) throw InputError(files.folder + ": no poses.txt, from which submaps would be labelled");
  return labelledDrive(files.folder, dataset, config, classes);
}

}  // namespace semantic_mht_slam
