#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/mapping/centroid_bias.h"
#include "semantic_mht_slam/mapping/fusion.h"
#include "semantic_mht_slam/mapping/hypothesis_tree.h"
#include "semantic_mht_slam/mapping/landmark_propagation.h"
#include "semantic_mht_slam/mapping/mapper_config.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

class StateArchive;

/// Builds submaps: stretches of fixed travelled length, each with a hypothesis tree of its own (paper, section II).
class Mapper {
 public:
  Mapper(const MapperConfig& config, const ClassTable& classes);

  /// Who is asked for the earlier map whenever a submap begins.
  void setEarlierMapProvider(EarlierMapProvider provider) { earlier_map_provider_ = std::move(provider); }

  /// Takes one frame: detections in the base frame, odometry at their stamp. Returns the submap that was full before
  /// the frame, if the frame begins a new one.
  std::optional<Submap> add(std::size_t frame, Stamp stamp, const Pose& T_odom_base, const Detections& detections,
                            Rng& rng);

  /// Ends the current submap; empty if it has no frame.
  std::optional<Submap> finish();

  /// Forgets where things were around the end of the last submap, as after a stretch without mapping. Only between
  /// submaps, else throws std::logic_error.
  void forgetSurroundings();

  /// The leaves of the current tree, most likely first.
  const std::vector<MapHypothesis>& hypotheses() const { return tree_.leaves(); }

  /// Index of the current submap; -1 before the first.
  int submapIndex() const { return index_; }

  /// Noise of a detection's centroid as it is known now: its own, else the calibrated one. Base frame, m^2.
  Eigen::Matrix3d detectorCov(const Detection& detection) const;

  /// The detection without the bias of its class's centroids, as estimated from the finished submaps.
  Detection corrected(const Detection& detection) const { return bias_.corrected(detection); }

  /// Bias of centroids, as estimated from the finished submaps.
  const CentroidBias& centroidBias() const { return bias_; }

  /// All that a mapper of the same class table needs to go on as if it had never stopped, the open submap included
  /// (see `StateArchive`). Whoever is asked for the earlier map is not part of it.
  void transfer(StateArchive& archive);

 private:
  /// A frame whose detections say something about the centroids' bias.
  struct Keyframe {
    std::size_t place = 0;  ///< in the frames of the submap
    Pose T_submap_base;     ///< by the odometry
    Detections detections;  ///< as they came

    void transfer(StateArchive& archive);
  };

  void begin(Stamp stamp, const Pose& T_odom_base);
  Measurement makeMeasurement(const Detection& detection);
  std::shared_ptr<const std::vector<ClassNoise>> noiseOfClasses(double range_m);
  void keepKeyframe(const Pose& T_submap_base, const Detections& detections);
  void joinEarlierMap(std::vector<MixtureLandmark>& landmarks, Submap& submap) const;
  void learnDetectionRate(const std::vector<FusedAssociations>& associations,
                          const std::vector<MixtureLandmark>& landmarks);
  bool learnsConfusion() const;
  void learnConfusion(const std::vector<FusedAssociations>& associations,
                      const std::vector<MixtureLandmark>& landmarks);
  BiasStretch biasStretch(const std::vector<FusedAssociations>& associations) const;

  MapperConfig config_;
  ClassTable classes_;
  DetectorCalibration calibration_;
  CentroidBias bias_;
  MultiHypothesisTree tree_;
  LandmarkPropagation propagation_;
  /// Of the present frame, by range; null until a detection there asks for it.
  std::array<std::shared_ptr<const std::vector<ClassNoise>>, DetectorCalibration::kRangeBins> noise_of_class_;
  EarlierMapProvider earlier_map_provider_;
  LandmarkId next_landmark_ = 1;
  int index_ = -1;
  bool is_open_ = false;
  Stamp begin_ = 0;
  Stamp end_ = 0;
  Pose T_odom_submap_;
  Pose T_odom_last_;
  double length_m_ = 0.0;
  std::vector<Pose> T_submap_base_;     ///< of each frame of this submap, by the odometry
  std::vector<std::vector<int>> rows_;  ///< of the measurements of each frame of this submap
  std::vector<Keyframe> keyframes_;
};

}  // namespace semantic_mht_slam
