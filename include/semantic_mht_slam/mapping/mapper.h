#pragma once

#include <algorithm>
#include <array>
#include <map>
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
#include "semantic_mht_slam/mapping/moving_objects.h"
#include "semantic_mht_slam/mapping/station_keeping.h"
#include "semantic_mht_slam/mapping/unsure_detections.h"
#include "semantic_mht_slam/models/frame.h"

namespace semantic_mht_slam {

class StateArchive;

/// When a landmark was seen in one pass, and whether it moved.
struct LandmarkSpan {
  SubmapId submap;  ///< that saw it last
  Stamp first = 0;
  Stamp last = 0;
  int sightings = 0;
  double moving = 0.0;  ///< sum of the probabilities that what the sightings show moves

  void transfer(StateArchive& archive);
};

/// Detections that show what moves, since the beginning.
struct MovingCounts {
  std::size_t flagged = 0;  ///< the detector said so, and they were left out
  std::size_t found = 0;    ///< their tracks say so, and they belong to no landmark

  void transfer(StateArchive& archive);
};

/// What comes out of a submap.
struct FinishedSubmap {
  Submap submap;
  std::vector<Frame> frames;              ///< calibrated (`Mapper::calibrated`)
  std::optional<MapAlignment> alignment;  ///< against the earlier map, if there was one and it fits somewhere
  UnsureDetections unsure;                ///< as far as they were asked for
};

/// Builds submaps: stretches of fixed travelled length, each with a hypothesis tree of its own (paper, section II).
class Mapper {
 public:
  Mapper(const MapperConfig& config, const ClassTable& classes, const RegistrationConfig& registration = {});

  /// Begins a submap where the odometry is, in surroundings that an earlier map may show. Only between submaps, else
  /// throws std::logic_error.
  void begin(const Pose& T_odom_submap, EarlierMap earlier_map = {});

  /// Takes a frame: detections in the base frame, odometry at their stamp. Only in a submap, else throws
  /// std::logic_error.
  void add(Frame frame, Rng& rng);

  bool isOpen() const { return is_open_; }

  /// True if the submap would be full with a frame at `T_odom_base`: the frame belongs to the next one.
  bool isFullAt(const Pose& T_odom_base) const;

  /// Ends the submap. Only in one that has a frame, else throws std::logic_error. What is explained of its detections
  /// changes nothing else.
  [[nodiscard]] FinishedSubmap finish(const ExplainLimits& explained = {});

  /// The submaps and landmarks that begin from now on are named after these. Only between submaps, else throws
  /// std::logic_error.
  void goOnAfter(SubmapId newest, LandmarkId newest_landmark);

  /// Forgets where things were around the end of the last submap, as after a stretch without mapping. Only between
  /// submaps, else throws std::logic_error.
  void forgetSurroundings();

  /// The leaves of the current tree, most likely first.
  const std::vector<MapHypothesis>& hypotheses() const { return tree_.leaves(); }

  /// The present submap, or the last one; none before the first.
  SubmapId submap() const { return id_; }

  /// How the odometry errs, as the finished submaps say.
  const OdometryModel& odometryModel() const { return odometry_.model(); }

  /// Relative standard deviation of the map's lengths: what is not known of the odometry's scale once the detector's
  /// ranges may be off, too.
  double scaleStddev() const {
    return std::max(bias_.scaleStddev(), odometry_.model().systematic.scale_translation.stddev);
  }

  const MovingCounts& movingCounts() const { return moving_counts_; }

  /// The detections without those that move, without the bias of their classes' centroids, and with the noise of their
  /// centroids stated, both as learned so far.
  Detections calibrated(Detections detections) const;

  /// All that a mapper of the same class table needs to go on as if it had never stopped, the open submap included
  /// (see `StateArchive`).
  void transfer(StateArchive& archive);

  /// Whether its submap follows so many finished ones.
  bool fits(std::size_t finished_submaps) const;

  /// The name that the next landmark gets.
  LandmarkId nextName() const { return next_landmark_; }

 private:
  void requireOpenSubmap(const StateArchive& archive) const;
  bool areTracked(const std::vector<Frame>& frames) const;
  Pose T_submap_base(const Frame& frame) const { return T_odom_submap_.inverse() * frame.T_odom_base; }
  Eigen::Matrix3d detectorCov(const Detection& detection) const;
  Measurement makeMeasurement(const Detection& detection);
  std::shared_ptr<const std::vector<ClassNoise>> noiseOfClasses(double range_m);
  void learn(const std::vector<FusedAssociations>& associations, const std::vector<MixtureLandmark>& landmarks);
  void learnDetectionRate(const std::vector<FusedAssociations>& associations,
                          const std::vector<MixtureLandmark>& landmarks);
  void dropMoving(Frame& frame);
  void trackMovable(const Frame& frame, const std::vector<Measurement>& measurements);
  double movingProb(std::size_t frame, std::size_t detection) const;
  void judgeMotion(const std::vector<FusedAssociations>& associations, std::vector<MixtureLandmark>& landmarks);
  void judgeAssociations(const std::vector<FusedAssociations>& fused, const std::vector<Frame>& frames,
                         const std::vector<MixtureLandmark>& landmarks, std::vector<DetectionAssociation>& associations,
                         UnsureSelection& unsure);
  void forgetSpans();
  bool learnsConfusion() const;
  void learnConfusion(const std::vector<FusedAssociations>& associations,
                      const std::vector<MixtureLandmark>& landmarks);
  void learnOdometry(const std::vector<FusedAssociations>& associations);
  double frameSpacing_m() const;
  double stationSpacing_m() const;
  Motion motionWith(const Pose& T_odom_base) const;
  BiasStretch biasStretch(const std::vector<FusedAssociations>& associations) const;

  MapperConfig config_;
  ClassTable classes_;
  DetectorCalibration calibration_;
  CentroidBias bias_;
  OdometryLearning odometry_;
  MovingObjects movers_;
  MultiHypothesisTree tree_;
  LandmarkPropagation propagation_;
  /// Of the present frame, by range; null until a detection there asks for it.
  std::array<std::shared_ptr<const std::vector<ClassNoise>>, DetectorCalibration::kRangeBins> noise_of_class_;
  LandmarkId next_landmark_ = 1;
  SubmapId id_;
  bool is_open_ = false;
  Pose T_odom_submap_;
  Motion motion_;                    ///< since the submap began
  std::vector<Frame> frames_;        ///< of this submap, as they came
  std::vector<std::size_t> spaced_;  ///< frames so far apart that each sees another error of a centroid
  StationKeeping stations_;
  /// Of each detection of each frame of this submap; none for classes that stand.
  std::vector<std::vector<std::optional<MovingObjects::TrackId>>> track_of_detection_;
  std::vector<DetectionAssociation> moving_;  ///< detections of this submap that the detector says move
  std::map<LandmarkId, LandmarkSpan> spans_;  ///< of the landmarks that are carried on
  double driven_m_ = 0.0;                     ///< up to the newest frame
  MovingCounts moving_counts_;
};

}  // namespace semantic_mht_slam
