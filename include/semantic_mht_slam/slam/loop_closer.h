#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/place/place_recognizer.h"
#include "semantic_mht_slam/place/submap_evaluator.h"
#include "semantic_mht_slam/slam/back_end_config.h"
#include "semantic_mht_slam/slam/place_units.h"

namespace semantic_mht_slam {

class StateArchive;

/// Where a submap that begins is believed to be, and where the keyframes were believed to be at that time.
struct SubmapPrediction {
  RegistrationPrior prior;  ///< of T_map_submap
  IdVector<KeyframeId, Pose> T_map_keyframe;
};

void transfer(StateArchive& archive, SubmapPrediction& prediction);

/// Whether a finished submap was searched for places seen before.
struct SubmapCheck {
  bool is_checked = false;
  SubmapEvaluation evaluation;
};

/// What is looked for in the earlier map.
struct ClosureQuery {
  IdRange<KeyframeId> keyframes;          ///< of the newest submap
  std::optional<MapAlignment> alignment;  ///< of that submap, found by its hypotheses
  SubmapPrediction prediction;            ///< that the alignment begins from
  double tied_at_m = 0.0;  ///< distance driven when the pose was last known, by other means than closures
};

/// Where a scene was found in the map.
struct FoundPlace {
  KeyframeId match;
  Pose T_match_base;
  PoseCov cov = PoseCov::Identity();
};

/// Finds places that were seen before, and checks them; does not change the map.
class LoopCloser {
 public:
  /// Throws InputError if the evaluator's tree is needed and cannot be used.
  /// The detector sees `range_factor` times as far as the reference (see `Length`).
  LoopCloser(const BackEndConfig& config, const ClassTable& classes, const RegistrationConfig& registration,
             double range_factor = 1.0);

  /// Takes the newest submap of the map in. The queries after this are about it.
  void add(const Map& map);

  /// The same for a submap, the next one, that is only to be found, and whose keyframes all have their poses.
  void takeIn(const Map& map, SubmapId submap);

  /// Closures of one source that were looked at; those that passed every check are verified. Of each source once a
  /// submap, in the order of `sources`: what one finds may correct the poses for the next.
  std::vector<LoopClosureRecord> find(ClosureSource source, const Map& map, const ClosureQuery& query);

  /// The sources that are switched on.
  std::vector<ClosureSource> sources() const;

  /// How the odometry errs, as far as that is known.
  void setOdometry(const OdometryModel& odometry) { odometry_ = odometry; }

  /// Where a submap begins that is believed to begin at `T_map_submap`, whose pose was known when `tied_at_m` were
  /// driven; `ahead` was driven since the newest keyframe.
  SubmapPrediction predict(const Map& map, const Pose& T_map_submap, double tied_at_m, const Motion& ahead) const;

  /// Where a scene is in the map, by its objects alone: it is laid onto what was seen around the keyframes most like
  /// it, and one way to do so has to stand out as a revisit's has (`RevisitConfig`). Needs a second find that agrees.
  /// Empty if it is not recognised.
  std::optional<FoundPlace> locate(const Map& map, const Scene& scene) const;

  /// Where a scene is in the map near an expected pose, `motion` after it was known within `stddev_m`; empty if that is
  /// not clear.
  std::optional<FoundPlace> findNear(const Map& map, const Scene& scene, const Pose& T_map_base, double stddev_m,
                                     const Motion& motion) const;

  /// Of every finished submap.
  const IdVector<SubmapId, SubmapCheck>& checks() const { return checks_; }

  const ClassTable& classes() const { return classes_; }

  const OdometryModel& odometry() const { return odometry_; }

  /// Into an empty one, or out of one (see `StateArchive`).
  void transfer(StateArchive& archive, const Map& map);

 private:
  /// One way to lay a scene onto what was seen around a keyframe.
  struct Placing {
    FoundPlace place;
    Pose T_map_base;
    double log_evidence = 0.0;
  };

  std::vector<Placing> placingsOf(const Scene& scene, const Map& map) const;
  std::vector<Pose> placePoses(const Map& map) const;
  bool isSearched(KeyframeId keyframe) const;
  std::vector<LoopClosureRecord> closeByHypotheses(const Map& map, const ClosureQuery& query) const;
  std::vector<LoopClosureRecord> recognisePlaces(const Map& map, const ClosureQuery& query);
  std::vector<LoopClosureRecord> revisits(const Map& map, const ClosureQuery& query) const;

  BackEndConfig config_;
  ClassTable classes_;
  RegistrationConfig registration_;
  PlaceUnits units_;
  OdometryModel odometry_;
  SubmapEvaluator evaluator_;
  PlaceRecognizer places_;
  std::vector<KeyframeId> keyframe_of_place_;
  IdVector<SubmapId, SubmapCheck> checks_;
};

}  // namespace semantic_mht_slam
