#include "semantic_mht_slam/slam/submap_archive.h"

#include <map>
#include <utility>

namespace semantic_mht_slam {

MixtureLandmark transformed(const Pose& T_a_b, const MixtureLandmark& landmark) {
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  const auto move = [&](Gaussian3& gaussian) {
    gaussian.mean_m = T_a_b * gaussian.mean_m;
    const Eigen::Matrix3d cov = R * gaussian.cov_m2 * R.transpose();
    gaussian.cov_m2 = 0.5 * (cov + cov.transpose());
  };
  MixtureLandmark result = landmark;
  move(result.position);
  for (MixtureComponent& component : result.components) move(component.position);
  return result;
}

void SubmapArchive::add(std::shared_ptr<const Submap> submap) {
  const int index = static_cast<int>(submaps_.size());
  for (const MixtureLandmark& landmark : submap->landmarks) landmarks_[landmark.id] = {index, landmark};
  for (const auto& [merged, survivor] : submap->merged) {
    survivor_of_[merged] = survivor;
    landmarks_.erase(merged);
  }
  submaps_.push_back(std::move(submap));
}

std::vector<MixtureLandmark> SubmapArchive::landmarks() const {
  std::map<LandmarkId, std::vector<LandmarkId>> merged_into;
  for (const auto& [merged, survivor] : survivor_of_) merged_into[resolve(survivor)].push_back(merged);
  std::vector<MixtureLandmark> result;
  for (const auto& [id, entry] : landmarks_) {
    if (!isKept(id)) continue;
    result.push_back(transformed(submaps_[static_cast<std::size_t>(entry.submap)]->T_odom_submap, entry.landmark));
    result.back().merged_ids = merged_into[id];
  }
  return result;
}

LandmarkId SubmapArchive::resolve(LandmarkId id) const {
  auto found = survivor_of_.find(id);
  while (found != survivor_of_.end()) {
    id = found->second;
    found = survivor_of_.find(id);
  }
  return id;
}

bool SubmapArchive::isKept(LandmarkId id) const {
  const auto found = landmarks_.find(id);
  return found != landmarks_.end() && found->second.landmark.existence_prob >= keep_prob_;
}

std::vector<DetectionAssociation> SubmapArchive::associations() const {
  std::vector<DetectionAssociation> result;
  for (const auto& submap : submaps_) {
    for (DetectionAssociation association : submap->associations) {
      association.landmark = resolve(association.landmark);
      if (!isKept(association.landmark)) association.landmark = kNoLandmark;
      result.push_back(association);
    }
  }
  return result;
}

}  // namespace semantic_mht_slam
