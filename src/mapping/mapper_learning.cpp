#include <map>
#include <set>

#include "semantic_mht_slam/mapping/mapper.h"

// What a submap teaches about the detector and the odometry.
namespace semantic_mht_slam {
namespace {

constexpr double kCertainExistence = 0.95;  // of landmarks that tell how often what exists is detected
constexpr double kCertainClass = 0.99;      // of landmarks that tell what a class is taken for

}  // namespace

bool Mapper::learnsConfusion() const {
  return config_.semantics && config_.association.learn_confusion &&
         config_.association.class_model == ClassModel::kConfusion;
}

void Mapper::learnConfusion(const std::vector<FusedAssociations>& associations,
                            const std::vector<MixtureLandmark>& landmarks) {
  std::map<LandmarkId, ClassIndex> certain;
  for (const MixtureLandmark& landmark : landmarks) {
    const bool is_certain = landmark.existence_prob >= kCertainExistence &&
                            landmark.class_probs.maxCoeff() >= kCertainClass && landmark.last_submap == id_;
    if (is_certain) certain[landmark.id] = landmark.mostLikelyClass();
  }
  for (const std::size_t k : spaced_) {
    const std::vector<LandmarkId>& ids = associations.at(k).landmark_of_measurement;
    const Detections& detections = frames_[k].detections;
    for (std::size_t i = 0; i < detections.size(); ++i) {
      const auto found = certain.find(ids[i]);
      if (found != certain.end()) tree_.confusion().add(found->second, detections[i].class_index);
    }
  }
}

void Mapper::learnDetectionRate(const std::vector<FusedAssociations>& associations,
                                const std::vector<MixtureLandmark>& landmarks) {
  std::vector<Pose> T_submap_base;
  for (const Frame& frame : frames_) T_submap_base.push_back(this->T_submap_base(frame));
  std::set<std::pair<LandmarkId, std::size_t>> seen;
  for (std::size_t k = 0; k < associations.size(); ++k) {
    for (const LandmarkId id : associations[k].landmark_of_measurement) seen.emplace(id, k);
  }
  for (const MixtureLandmark& landmark : landmarks) {
    if (landmark.existence_prob < kCertainExistence || landmark.last_submap != id_) continue;
    const ClassIndex class_index = landmark.mostLikelyClass();
    for (std::size_t k = 0; k < T_submap_base.size(); ++k) {
      const Pose& T = T_submap_base[k];
      const Eigen::Vector3d position_m = T.rotation.conjugate() * (landmark.position.mean_m - T.translation_m);
      tree_.detectionRate().add(class_index, position_m, seen.count({landmark.id, k}) > 0);
    }
  }
}

BiasStretch Mapper::biasStretch(const std::vector<FusedAssociations>& associations) const {
  BiasStretch stretch;
  for (const std::size_t k : spaced_) {
    const int index = static_cast<int>(stretch.T_stretch_base.size());
    stretch.T_stretch_base.push_back(T_submap_base(frames_[k]));
    const std::vector<LandmarkId>& landmarks = associations.at(k).landmark_of_measurement;
    const Detections& detections = frames_[k].detections;
    for (std::size_t i = 0; i < detections.size(); ++i) {
      if (landmarks[i] == kNoLandmark) continue;
      const Detection& detection = detections[i];
      Eigen::Matrix3d cov = detectorCov(detection);
      cov.diagonal().head<2>().array() += frameSpacing_m() * calibration_.wanderVariancePerMetre(detection.class_index);
      stretch.observations.push_back({index, detection.position_m, cov, detection.class_index, landmarks[i]});
    }
  }
  return stretch;
}

void Mapper::learn(const std::vector<FusedAssociations>& associations, const std::vector<MixtureLandmark>& landmarks) {
  if (config_.bias.enabled) {
    bias_.add(biasStretch(associations), odometry_.model().noise);
  }
  learnOdometry(associations);
  learnDetectionRate(associations, landmarks);
  if (learnsConfusion()) learnConfusion(associations, landmarks);
}

}  // namespace semantic_mht_slam
