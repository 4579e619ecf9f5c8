#include "saved_results.h"

#include <filesystem>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/staged_folder.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kTum = "trajectory.tum";
constexpr const char* kKitti = "trajectory.txt";
constexpr const char* kCsv = "landmarks.csv";
constexpr const char* kGeoJson = "landmarks.geojson";

/// A name of what is in a folder, beside what a save that was killed left; empty if there is nothing.
std::string somethingIn(const std::string& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!StagedFolder::isStaging(name)) return name;
  }
  if (error) throw InputError("cannot look into '" + folder + "': " + error.message());
  return {};
}

/// A folder that there is not, that is empty, or that holds all of the files.
void requireOwn(const std::string& folder) {
  if (!isFolder(folder)) return;
  std::string absent;
  for (const char* name : {kTum, kKitti, kCsv, kGeoJson}) {
    if (!mayExist(folder + "/" + name)) absent = name;
  }
  if (absent.empty()) return;
  const std::string present = somethingIn(folder);
  if (present.empty()) return;
  throw InputError("cannot write to '" + folder + "': there is a '" + present + "' and no '" + absent +
                   "', so it is not of this service, and stays; choose another folder");
}

}  // namespace

void saveResults(const std::string& folder, const std::vector<StampedPose>& T_map_base,
                 const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes,
                 const std::optional<MapOrigin>& origin) {
  requireOwn(folder);
  StagedFolder staged(folder);
  std::vector<Pose> poses;
  for (const StampedPose& pose : T_map_base) poses.push_back(pose.T_world_base);
  const auto write = [&](const char* name, const std::string& content) {
    writeFileAtomically(staged.staging() + "/" + name, content);
  };
  write(kTum, formatTumTrajectory(T_map_base));
  write(kKitti, formatKittiTrajectory(poses));
  write(kCsv, landmarksCsv(landmarks, classes));
  write(kGeoJson, landmarksGeoJson(landmarks, classes, origin));
  staged.commit();
}

}  // namespace semantic_mht_slam
