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
  lasting_.emplace_back();
  for (MixtureLandmark landmark : submap->landmarks) {
    landmark.id = resolve(landmark.id);
    place(index, std::move(landmark));
  }
  for (const auto& [merged, survivor] : submap->merged) {
    // What the mapper merged, it has already put together in the survivor.
    if (resolve(merged) == resolve(survivor)) continue;
    remove(resolve(merged));
    merge(merged, survivor);
  }
  submaps_.push_back(std::move(submap));
}

void SubmapArchive::merge(LandmarkId merged, LandmarkId survivor) {
  merged = resolve(merged);
  survivor = resolve(survivor);
  if (!merged_ids_.merge(merged, survivor)) return;
  const MixtureLandmark* gone = find(merged);
  if (gone == nullptr) return;
  MixtureLandmark* kept = find(survivor);
  if (kept == nullptr) {
    MixtureLandmark renamed = *gone;
    renamed.id = survivor;
    place(submap_of_.at(merged), std::move(renamed));
  } else {
    kept->observations += gone->observations;
    kept->existence_prob = std::max(kept->existence_prob, gone->existence_prob);
    kept->first_submap = std::min(kept->first_submap, gone->first_submap);
    kept->last_submap = std::max(kept->last_submap, gone->last_submap);
  }
  remove(merged);
}

const MixtureLandmark* SubmapArchive::find(LandmarkId id) const {
  const auto known = submap_of_.find(id);
  if (known == submap_of_.end()) return nullptr;
  return findLandmark(id, lasting_[static_cast<std::size_t>(known->second)].landmarks);
}

MixtureLandmark* SubmapArchive::find(LandmarkId id) {
  const MixtureLandmark* landmark = std::as_const(*this).find(id);
  if (landmark == nullptr) return nullptr;
  auto& landmarks = lasting_[static_cast<std::size_t>(submap_of_.at(id))].landmarks;
  return &landmarks[static_cast<std::size_t>(landmark - landmarks.data())];
}

void SubmapArchive::place(int submap, MixtureLandmark landmark) {
  remove(landmark.id);
  Lasting& lasting = lasting_[static_cast<std::size_t>(submap)];
  lasting.reach_m = std::max(lasting.reach_m, landmark.position.mean_m.norm());
  submap_of_[landmark.id] = submap;
  lasting.landmarks.insert(placeOf(landmark.id, lasting.landmarks), std::move(landmark));
}

void SubmapArchive::remove(LandmarkId id) {
  const MixtureLandmark* known = find(id);
  if (known == nullptr) return;
  auto& landmarks = lasting_[static_cast<std::size_t>(submap_of_.at(id))].landmarks;
  landmarks.erase(landmarks.begin() + (known - landmarks.data()));
  submap_of_.erase(id);
}

void SubmapArchive::forEachLandmark(
    const std::function<void(int submap, const MixtureLandmark& landmark)>& visit) const {
  for (const auto& [id, submap] : submap_of_) {
    const MixtureLandmark& landmark = *find(id);
    if (isKept(landmark)) visit(submap, landmark);
  }
}

void SubmapArchive::forEachLandmarkOf(int submap,
                                      const std::function<void(const MixtureLandmark& landmark)>& visit) const {
  for (const MixtureLandmark& landmark : lasting_[static_cast<std::size_t>(submap)].landmarks) {
    if (isKept(landmark)) visit(landmark);
  }
}

std::map<LandmarkId, std::vector<LandmarkId>> SubmapArchive::mergedInto() const {
  std::map<LandmarkId, std::vector<LandmarkId>> merged_into;
  for (const auto& [merged, survivor] : merged_ids_.survivors()) merged_into[resolve(survivor)].push_back(merged);
  return merged_into;
}

bool SubmapArchive::isKept(LandmarkId id) const {
  const MixtureLandmark* landmark = find(id);
  return landmark != nullptr && isKept(*landmark);
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
