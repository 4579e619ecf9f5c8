#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "semantic_mht_slam/graph/pose_graph.h"
#include "semantic_mht_slam/graph/trajectory_correction.h"
#include "semantic_mht_slam/map/merged_ids.h"
#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/models/odometry_noise.h"
#include "semantic_mht_slam/place/place_recognizer.h"
#include "semantic_mht_slam/place/submap_evaluator.h"
#include "semantic_mht_slam/slam/keyframes.h"
#include "semantic_mht_slam/slam/loop_closure_record.h"
#include "semantic_mht_slam/slam/revisit_search.h"
#include "semantic_mht_slam/slam/submap_archive.h"

namespace semantic_mht_slam {

class StateArchive;

/// Everything behind the mapper.
struct BackEndConfig {
  bool close_loops = true;
  bool recognise_places = true;
  bool landmark_factors = true;
  int closure_stride = 2;
  double max_closure_distance_m = 5.0;
  double loop_cov_scale = 1.0;
  double loop_floor_m = 0.1;
  double loop_floor_rad = 0.005;
  KeyframeConfig keyframe;
  SubmapEvaluatorConfig evaluator;  ///< `tree` is opened as it stands
  PlaceConfig place;
  RevisitConfig revisit;
  PoseGraphConfig graph;
};

void describe(BackEndConfig& config, Fields& fields);

/// Where a submap that begins is believed to be, and where the earlier map was believed to be at that time.
struct SubmapPrediction {
  AlignmentPrior prior;  ///< of T_map_submap
  std::vector<Pose> T_map_keyframe;
  double driven_m = 0.0;  ///< up to the newest keyframe; not needed later, but map files hold it (section `input`)
};

/// Whether a finished submap was searched for places seen before.
struct SubmapCheck {
  int first_keyframe = 0;
  bool is_checked = false;
  SubmapEvaluation evaluation;
};

/// Ties finished submaps together: keyframes and landmarks go into the pose graph, places that are seen again become
/// loop closures, and landmarks that turn out to be the same become one.
class BackEnd {
 public:
  /// Throws InputError if the evaluator's tree is needed and cannot be used.
  BackEnd(const BackEndConfig& config, const OdometryNoise& odometry, const ClassTable& classes);

  /// For a submap that begins at `T_odom_submap`.
  SubmapPrediction predict(const Pose& T_odom_submap) const;

  /// Takes a finished submap with its keyframes and optimises; its alignment is in the frame of `prediction`. Returns
  /// the landmarks that were found to be the same.
  std::vector<MergedLandmark> add(std::vector<MapKeyframe> keyframes, const Submap& submap,
                                  const SubmapPrediction& prediction);

  /// Solves the whole graph.
  void finish();

  /// The next keyframe follows the ones before by a pose in the map, known within about a metre, not by odometry;
  /// `driven_m` then.
  void goOnAt(const Pose& T_map_odom, double driven_m);

  /// Keyframes with their corrected poses.
  const KeyframeMap& keyframes() const { return map_; }

  /// Correction of the odometry at the newest keyframe.
  Pose T_map_odom() const;

  /// Corrected pose of a submap, by its index.
  Pose T_map_submap(int submap) const;

  /// Every closure that was looked at, in the order of the query.
  const std::vector<LoopClosureRecord>& closures() const { return closures_; }

  const ClassTable& classes() const { return classes_; }

  /// Where a scene is in the map, by its objects alone; needs a second find that agrees. Empty if it is not recognised.
  std::optional<Pose> locate(const Scene& scene) const;

  /// Where a scene is in the map near an expected pose, `drifted_m` after it was known; empty if that is not clear.
  std::optional<Pose> findNear(const Scene& scene, const Pose& T_map_base, double drifted_m) const;

  /// Every finished submap, by its index.
  const std::vector<SubmapCheck>& checks() const { return checks_; }

  /// Keyframes and closures: into an empty back end, or out of one (see `StateArchive`). `submaps` are those that the
  /// keyframes were cut from. Of closures that were refused only what people look at is kept.
  void transferKeyframes(StateArchive& archive, const SubmapArchive& submaps);

  /// The pose graph and the state of place recognition; to be read after the keyframes.
  void transferGraph(StateArchive& archive, const SubmapArchive& submaps);

  /// Corrected position of a landmark, map frame; empty if it is not in the graph.
  std::optional<Eigen::Vector3d> landmark(LandmarkId id) const;

 private:
  void addNode(const MapKeyframe& keyframe);
  void recognisePlaces(std::size_t first_new, const Submap& submap);
  void closeByHypotheses(std::size_t first_new, const MapAlignment& alignment, const SubmapPrediction& prediction);
  void findRevisitsOf(std::size_t first_new);
  void close(std::vector<LoopClosureRecord> records);
  void accept(const LoopClosureRecord& record);
  bool mergeLandmarks(LandmarkId merged, LandmarkId survivor);
  void readBack();
  int submapOf(int keyframe) const;

  BackEndConfig config_;
  OdometryNoise odometry_noise_;
  ClassTable classes_;
  PoseGraph graph_;
  SubmapEvaluator evaluator_;
  PlaceRecognizer places_;
  std::vector<int> keyframe_of_place_;
  KeyframeMap map_;
  std::vector<SubmapCheck> checks_;
  std::vector<LoopClosureRecord> closures_;
  std::vector<int> closure_of_loop_;      ///< index into `closures_`, by loop of the graph
  std::optional<Pose> T_map_odom_start_;  ///< of a session that has no keyframe yet
  double closed_at_m_ = 0.0;              ///< distance driven at the last accepted closure
  MergedIds merged_ids_;
  std::map<LandmarkId, std::set<int>> keyframes_of_;  ///< that saw a landmark of the graph
  std::vector<MergedLandmark> newly_merged_;
};

}  // namespace semantic_mht_slam
