#include "semantic_mht_slam/slam/submap_archive.h"

#include <algorithm>
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
  for (const MixtureLandmark& landmark : submap->landmarks) {
    const LandmarkId id = resolve(landmark.id);
    landmarks_[id] = {index, landmark};
    landmarks_[id].landmark.id = id;
  }
  for (const auto& [merged, survivor] : submap->merged) {
    // What the mapper merged, it has already put together in the survivor.
    if (resolve(merged) == resolve(survivor)) continue;
    landmarks_.erase(resolve(merged));
    merge(merged, survivor);
  }
  submaps_.push_back(std::move(submap));
}

void SubmapArchive::merge(LandmarkId merged, LandmarkId survivor) {
  merged = resolve(merged);
  survivor = resolve(survivor);
  if (!merged_ids_.merge(merged, survivor)) return;
  const auto gone = landmarks_.find(merged);
  if (gone == landmarks_.end()) return;
  const auto kept = landmarks_.find(survivor);
  if (kept == landmarks_.end()) {
    landmarks_[survivor] = gone->second;
    landmarks_[survivor].landmark.id = survivor;
  } else {
    MixtureLandmark& landmark = kept->second.landmark;
    const MixtureLandmark& other = gone->second.landmark;
    landmark.observations += other.observations;
    landmark.existence_prob = std::max(landmark.existence_prob, other.existence_prob);
    landmark.first_submap = std::min(landmark.first_submap, other.first_submap);
    landmark.last_submap = std::max(landmark.last_submap, other.last_submap);
  }
  landmarks_.erase(merged);
}

void SubmapArchive::forEachLandmark(
    const std::function<void(int submap, const MixtureLandmark& landmark)>& visit) const {
  for (const auto& [id, entry] : landmarks_) {
    if (isKept(entry)) visit(entry.submap, entry.landmark);
  }
}

std::map<LandmarkId, std::vector<LandmarkId>> SubmapArchive::mergedInto() const {
  std::map<LandmarkId, std::vector<LandmarkId>> merged_into;
  for (const auto& [merged, survivor] : merged_ids_.survivors()) merged_into[resolve(survivor)].push_back(merged);
  return merged_into;
}

bool SubmapArchive::isKept(LandmarkId id) const {
  const auto found = landmarks_.find(id);
  return found != landmarks_.end() && isKept(found->second);
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
