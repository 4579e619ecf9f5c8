#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/mapping/mapper.h"
#include "semantic_mht_slam/slam/back_end.h"
#include "semantic_mht_slam/slam/frame.h"
#include "semantic_mht_slam/slam/frame_assembler.h"
#include "semantic_mht_slam/slam/localizer.h"
#include "semantic_mht_slam/slam/slam_state.h"
#include "semantic_mht_slam/slam/submap_archive.h"
#include "semantic_mht_slam/slam/trajectory_record.h"

namespace semantic_mht_slam {

/// How the trajectory is estimated.
enum class Method {
  kOdometry,  ///< the odometry as it is, no map
  kUkf,       ///< baseline: one hypothesis, nearest neighbours
  kMhm,       ///< baseline: maximum likelihood multiple-hypothesis mapping
  kDpmhm,     ///< Dirichlet-process multiple-hypothesis mapping
};

std::string nameOf(Method method);

/// Configuration of the estimator.
struct SlamConfig {
  Method method = Method::kDpmhm;
  std::uint64_t seed = 1;
  FrameAssemblerConfig input;
  MapperConfig mapper;
  BackEndConfig back_end;
  LocalizerConfig localization;
};

/// The defaults that belong to a method.
SlamConfig defaultsOf(Method method);

void describe(SlamConfig& config, Fields& fields);

/// True if `next` may be the odometry after `last` of the same drive: later, but at most a minute, and no further than
/// a fast car comes meanwhile.
bool goesOn(const StampedPose& last, const StampedPose& next);

/// The estimator: odometry and detections in, trajectory and map out. Single-threaded; the same input gives the same
/// result whatever the order in which odometry and detections arrive.
class Slam {
 public:
  /// Throws InputError if the submap evaluator's tree is needed and cannot be used.
  Slam(const SlamConfig& config, const ClassTable& classes);
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  /// Goes on where `state` was taken. Parameters may differ from those that it was made with, but for the method, the
  /// class table and the sizes of the pose graph's chunks; with the same ones the result is the same to the last bit as
  /// without the interruption. Throws InputError if the state is broken, newer or does not fit, or if reading is given
  /// up.
  Slam(const SlamConfig& config, const ClassTable& classes, const SlamState& state,
       const KeepReading& keep_reading = {});

  /// Everything that is needed to go on from here.
  SlamState snapshot() const;

  /// One odometry sample T_odom_base. Bad ones are dropped and counted; true if it was used.
  bool addOdometry(const StampedPose& T_odom_base);

  /// What the detector saw at `stamp`, in the base frame. Bad ones are dropped and counted.
  void addDetections(Stamp stamp, Detections detections);

  /// Correction of the odometry: T_map_base = T_map_odom * T_odom_base.
  Pose T_map_odom() const;

  /// T_map_base at every odometry sample that was used, in the order of time, one session after the other.
  std::vector<StampedPose> trajectory() const { return trajectoryOf(trajectoryRecord()); }

  /// What the trajectory is put together from; takes much less time than that.
  TrajectoryRecord trajectoryRecord() const;

  /// T_map_base at the newest odometry sample; empty before the first.
  std::optional<StampedPose> latestPose() const;

  /// The newest odometry of the present session as it came in, T_odom_base; empty before the first.
  std::optional<StampedPose> latestOdometry() const;

  /// The newest frame that found its odometry; empty before the first.
  const std::optional<Frame>& latestFrame() const { return latest_frame_; }

  /// Ends the current submap, so that what it saw is in the map.
  void finish();

  /// From now on the map stays as it is, and the vehicle finds itself in it. Where it is, is known if the odometry goes
  /// on from mapping; else it is looked for (see `Localizer`). Throws std::logic_error if there is no finished submap.
  void localize();

  /// Maps again. After localization the map goes on where the vehicle was found in it; while it is still lost, mapping
  /// waits until it is found.
  void resumeMapping();

  /// The odometry that comes now has nothing to do with the one before, neither its frame nor its stamps: the vehicle
  /// is lost until it finds itself in the map. Without any finished submap it just begins to map.
  void beginSession();

  /// Where the base is in the map, from outside, within about `stddev_m`: ends being lost. Has no effect while mapping
  /// or before any odometry; true if it had one.
  bool expectAt(const Pose& T_map_base, double stddev_m);

  /// True if the map is not added to: by choice, or because the vehicle is not found yet.
  bool isLocalizing() const { return localizer_.has_value() && !is_following_; }

  /// True if the map is not added to because the place was mapped `localization.known_passes` times.
  bool isFollowing() const { return is_following_; }

  /// True if the vehicle knows where it is in the map.
  bool isLocated() const { return !localizer_ || localizer_->isLocated(); }

  /// The submaps that are finished.
  const SubmapArchive& map() const { return map_; }

  /// The landmarks of the map at their corrected places, map frame, by rising id.
  std::vector<MixtureLandmark> landmarks() const;

  /// Keyframes, loop closures and their corrections; null for the method `odometry`.
  const BackEnd* backEnd() const { return back_end_ ? &*back_end_ : nullptr; }

  /// The hypotheses of the current submap, most likely first; empty for the method `odometry`.
  const std::vector<MapHypothesis>& hypotheses() const;

  /// Index of the current submap; -1 before the first.
  int submapIndex() const { return mapper_ ? mapper_->submapIndex() : -1; }

  /// Wall time that the mapper took so far (association, hypotheses, fusion; not the back end), s.
  double mappingSeconds() const { return mapping_s_; }

  const InputCounters& counters() const { return assembler_.counters(); }

 private:
  using SectionTransfer = void (Slam::*)(StateArchive& archive);

  /// Names of the sections in the order in which they are read, with their versions.
  struct Section {
    const char* name;
    int version;
    SectionTransfer transfer;
  };
  static const std::vector<Section>& sections();

  void transferInput(StateArchive& archive);
  void transferSubmaps(StateArchive& archive);
  void transferKeyframes(StateArchive& archive);
  void transferGraph(StateArchive& archive);
  void transferMapper(StateArchive& archive);
  /// A stretch of one odometry.
  struct Session {
    std::size_t first_odometry = 0;
    std::size_t first_keyframe = 0;
    std::vector<MapFix> fixes;  ///< by localization

    void transfer(StateArchive& archive);
  };

  void processReadyFrames();
  void map(const Frame& frame);
  void localizeBy(const Frame& frame);
  void endSubmap();
  void follow();
  void restore(const SlamState& state, const KeepReading& keep_reading);
  void localizeNearLastFix();
  bool isKnown(const Eigen::Vector3d& position_m) const;
  bool isKnownSince(std::size_t first_keyframe) const;
  void take(Submap submap);
  EarlierMap earlierMap(const Pose& T_odom_submap);
  Pose T_map_submap(int submap) const;
  MixtureLandmark inMap(int submap, const MixtureLandmark& seen) const;

  Method method_;
  FrameAssembler assembler_;
  Rng rng_;
  std::optional<Mapper> mapper_;
  std::optional<BackEnd> back_end_;
  SubmapPrediction prediction_;       ///< of the open submap
  SubmapPrediction next_prediction_;  ///< of the submap that begins while the one before is being finished
  std::vector<Frame> submap_frames_;  ///< of the submap that is open
  double driven_m_ = 0.0;             ///< up to the newest frame
  double submap_driven_m_ = 0.0;      ///< up to the first frame of the open submap
  OdometryNoise odometry_noise_;
  KeyframeConfig keyframe_config_;
  double keep_prob_;
  int earlier_after_submaps_ = 0;  ///< what was not seen in so many submaps is of an earlier pass
  SubmapArchive map_;
  std::vector<StampedPose> odometry_;
  std::vector<Session> sessions_{1};
  LocalizerConfig localizer_config_;
  std::optional<Localizer> localizer_;  ///< while the map is not added to
  bool is_mapping_wanted_ = true;
  bool is_place_known_ = false;  ///< that of the newest finished submap
  bool is_following_ = false;
  std::optional<Frame> latest_frame_;
  double mapping_s_ = 0.0;
};

}  // namespace semantic_mht_slam
