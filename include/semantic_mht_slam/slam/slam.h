#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/mapping/detector_range.h"
#include "semantic_mht_slam/mapping/mapper.h"
#include "semantic_mht_slam/models/frame.h"
#include "semantic_mht_slam/slam/frame_assembler.h"
#include "semantic_mht_slam/slam/gnss_fixes.h"
#include "semantic_mht_slam/slam/loop_closer.h"
#include "semantic_mht_slam/slam/map_graph.h"
#include "semantic_mht_slam/slam/map_uncertainty.h"
#include "semantic_mht_slam/slam/mode.h"
#include "semantic_mht_slam/slam/odometry_continuity.h"
#include "semantic_mht_slam/slam/sessions.h"
#include "semantic_mht_slam/slam/slam_state.h"
#include "semantic_mht_slam/slam/standstill.h"

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
  RegistrationConfig registration;
  MapperConfig mapper;
  BackEndConfig back_end;
  LocalizerConfig localization;
  GnssConfig gnss;  ///< described by `SystemConfig`: without fixes it says nothing of a map
};

/// The defaults that belong to a method.
SlamConfig defaultsOf(Method method);

void describe(SlamConfig& config, Fields& fields);

/// The configuration with the lengths of a detector that sees `range_factor` times as far as the reference. What
/// `odometry` begins with is scaled, too, if it is learned: a vehicle of half the size drives half as far for the same
/// error of its heading.
SlamConfig fittedTo(const SlamConfig& config, double range_factor);

/// What a person says of two poses of the trajectory.
struct RequestedClosure {
  Stamp query = 0;
  Stamp match = 0;  ///< of the earlier pose
  Pose T_match_query;
  FixedAxesCov cov = FixedAxesCov::Zero();  ///< of it; zero: half a metre and 3 degrees
};

/// What an open submap knows: its hypotheses, most likely first, and T_map_submap.
struct MappedAhead {
  std::vector<MapHypothesis> hypotheses;
  Pose T_map_submap;
};

/// What the estimator is made of, all of which outlives a program in a map file.
struct SlamParts {
  FrameAssembler assembler;
  Rng rng;
  std::optional<Mapper> mapper;  ///< none for the method `odometry`
  Map map;                       ///< finished submaps and what follows from them
  MapGraph graph;
  std::optional<LoopCloser> closer;  ///< the same
  Sessions sessions;
  Mode mode;
  std::optional<Frame> latest_frame;  ///< the newest one that found its odometry
  SubmapPrediction prediction;        ///< of the open submap
  Motion driven = {};                 ///< up to the newest frame
  Motion submap_driven = {};          ///< up to the first frame of the open submap
  double tied_at_m = 0.0;             ///< driven when localization last gave mapping a pose
  double mapping_s = 0.0;             ///< wall time that the mapper took so far (association, hypotheses, fusion)
  OdometryContinuity continuity = {};
  std::optional<StampedPose> unconfirmed = {};  ///< sample that no motion leads to, until the next one is here
  Standstill standing = {};
  DetectorRange detector_range = {};
  double range_factor = 1.0;                 ///< of the detector by the reference, as far as it is known
  bool is_fitted = false;                    ///< the lengths are those of the detector
  std::vector<Frame> waiting = {};           ///< frames that are mapped when they are
  OdometryModel odometry = {};               ///< as far as it is known
  std::optional<UncertainPose> latest = {};  ///< at the newest odometry sample; none while the vehicle is lost
  FixedAxesCov start_cov = gaugeCov();       ///< of the first keyframe, which may come long after the first pose
  GnssFixes fixes{GnssConfig{}};
};

/// Makes mapper, graph and loop closer anew for a configuration whose lengths have changed (see `fittedTo`).
void fitParts(const SlamConfig& fitted, const ClassTable& classes, SlamParts& parts);

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
  /// without the interruption; what has been read of the state is given up. Throws InputError if it is broken, newer
  /// or does not fit, or if reading is given up.
  Slam(const SlamConfig& config, const ClassTable& classes, SlamState state, const KeepReading& keep_reading = {});

  /// Everything that is needed to go on from here.
  SlamState snapshot() const;

  /// One odometry sample T_odom_base. Bad ones are dropped and counted; true if it was used. One that no motion leads
  /// to from the newest waits for the next one: if a motion leads to that from the one that waits, they begin a
  /// session, else that is dropped.
  bool addOdometry(const StampedPose& T_odom_base);

  /// What the detector saw at `stamp`, in the base frame. Bad ones are dropped and counted.
  void addDetections(Stamp stamp, Detections detections);

  /// A position by satellites. Bad ones are dropped and counted (see `GnssFixes`). False if localization was chosen:
  /// then it is ignored, as the map stays as it is.
  bool addFix(const GnssFix& fix);

  /// Ends the current submap, so that what it saw is in the map, and solves the whole pose graph.
  void finish();

  /// From now on the map stays as it is, and the vehicle finds itself in it. Where it is, is known if the odometry goes
  /// on from mapping; else it is looked for (see `Localizer`). Throws std::logic_error if there is no finished submap.
  void localize();

  /// Maps again. After localization the map goes on where the vehicle was found in it; while it is still lost, mapping
  /// waits until it is found.
  void resumeMapping();

  /// The odometry that comes now has nothing to do with the one before, neither its frame nor its stamps: the vehicle
  /// is lost until it finds itself in the map. Without any finished submap it just begins to map.
  void beginSession() { beginSession(std::numeric_limits<Stamp>::max()); }

  // What a person knows better. Each of these ends the current submap, so that what it saw is in the map. They throw
  // InputError, and change nothing else, for what there is not in the map.

  /// Takes a landmark, by any of its names, out of the map: it stays out when it is seen again, and when the map is
  /// saved and loaded.
  void removeLandmark(LandmarkId name);

  /// Brings back what `removeLandmark` took.
  void bringBackLandmark(LandmarkId name);

  /// Keeps a landmark as it is: it exists, and its place, class and size stay, whatever is seen. Its place moves with
  /// the submap that saw it last when the map is corrected.
  void lockLandmark(LandmarkId name);
  void unlockLandmark(LandmarkId name);

  /// Ties two places of the trajectory together, whatever odometry and other closures say; landmarks of both that then
  /// stand at the same place become one.
  ClosureId addClosure(const RequestedClosure& closure);

  /// Takes a closure that holds back, with everything that it merged.
  void removeClosure(ClosureId closure);

  /// Where the base is in the map, from outside, within about `stddev_m`: ends being lost. Has no effect while mapping
  /// or before any odometry; true if it had one.
  bool expectAt(const Pose& T_map_base, double stddev_m);

  /// What is explained of the detections of submaps that end from now on (see `takeUnsure`); by default nothing.
  void explain(const ExplainLimits& limits) { explained_ = limits; }

  /// Detections of the submaps that ended since the last call whose landmarks are not sure. Names are those that the
  /// submap gave.
  std::vector<UnsureDetections> takeUnsure() { return std::exchange(unsure_, {}); }

  /// Correction of the odometry: T_map_base = T_map_odom * T_odom_base.
  Pose T_map_odom() const;

  /// The submap that the frames make up which wait for the lengths of the detector, with these lengths as far as they
  /// are known; none if no frame waits.
  std::optional<MappedAhead> mapAhead() const;

  const SlamParts& parts() const { return parts_; }
  const Map& map() const { return parts_.map; }
  const Mode& mode() const { return parts_.mode; }

 private:
  bool isReached(const StampedPose& T_odom_base);
  bool take(const StampedPose& T_odom_base);
  /// Frames from `begin` on are of the session.
  void beginSession(Stamp begin);
  void processReadyFrames();
  void process(const Frame& frame);
  /// The lengths are those of the detector from now on; the frames that waited for it are mapped.
  void fitToDetector();
  void follow(const Frame& frame);
  void endSubmap();
  void enter(Mode mode);
  MixtureLandmark requireLandmark(LandmarkId name);
  void settleRequest();

  SlamConfig config_;
  ClassTable classes_;
  SlamConfig fitted_;  ///< with the lengths of the detector
  SlamParts parts_;
  ExplainLimits explained_;
  std::vector<UnsureDetections> unsure_;
};

/// True if `next` may be the odometry after the newest of the same drive (see `OdometryContinuity`), within a minute.
bool goesOn(const Slam& slam, const StampedPose& next);

/// What the trajectory is put together from; takes much less time than that.
TrajectoryRecord trajectoryRecordOf(const Slam& slam);

/// T_map_base at every odometry sample that was used, in the order of time, one session after the other.
std::vector<StampedPose> trajectoryOf(const Slam& slam);

/// T_map_base at the newest odometry sample; empty before the first.
std::optional<StampedPose> latestPoseOf(const Slam& slam);

/// Covariance of that pose, axes of the map; empty while the vehicle does not know where it is in the map.
std::optional<FixedAxesCov> latestCovOf(const Slam& slam);

/// Covariances of the whole map, in time that grows with it; and of each pose of the trajectory by these.
MapUncertainty uncertaintyOf(const Slam& slam);
std::vector<FixedAxesCov> trajectoryCovOf(const Slam& slam, const MapUncertainty& uncertainty);

/// The landmarks of the map at their corrected places, map frame, by rising id. Without the uncertainty of the whole
/// map their covariances are those that go out live, a little wider.
std::vector<MixtureLandmark> landmarksOf(const Slam& slam);
std::vector<MixtureLandmark> landmarksOf(const Slam& slam, const MapUncertainty& uncertainty);

/// What the open submap has seen and the map lacks, by rising id, map frame: fused over the hypotheses as if it ended
/// now; before the first submap, what the frames show that wait (see `Slam::mapAhead`). Ids stay, places and existence
/// may change until the submap is finished.
std::vector<MixtureLandmark> provisionalLandmarksOf(const Slam& slam);

/// The hypotheses of the current submap, most likely first; empty for the method `odometry`.
const std::vector<MapHypothesis>& hypothesesOf(const Slam& slam);

}  // namespace semantic_mht_slam
