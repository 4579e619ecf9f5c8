#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/assignment.h"
#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

class StateArchive;

/// How objects that move are told from those that stand.
struct MovingConfig {
  bool find = true;
  double prior_prob = 0.3;
  Length speed_stddev_mps{10.0};
};

void describe(MovingConfig& config, Fields& fields);

/// A detection of a class whose objects may move.
struct MovableSighting {
  ClassIndex class_index = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< odometry frame
  Eigen::Matrix2d cov_m2 = Eigen::Matrix2d::Identity();  ///< of the detector, same axes
  double wander_variance_per_m = 0.0;                    ///< what its centroid wanders with the way of the vehicle
};

/// Tracks from frame to frame what may move, each with two models side by side: it stands, or it moves at a velocity
/// that changes slowly. Their likelihoods make the probability that it moves (multiple-model estimation, Bar-Shalom et
/// al., Estimation with Applications to Tracking and Navigation, 2001, section 11.6).
class MovingObjects {
 public:
  using TrackId = std::size_t;

  /// Detections further than `max_gate_m` from where a track is expected are not its own.
  MovingObjects(const MovingConfig& config, int class_count, double max_gate_m);

  /// Takes the sightings of the next frame, with the way driven up to it. Returns the track of each.
  std::vector<TrackId> add(Stamp stamp, double driven_m, const std::vector<MovableSighting>& sightings);

  /// Probability that what a track shows moves, as far as is known now. Throws std::out_of_range for a track that was
  /// forgotten.
  double movingProb(TrackId track) const { return known_prob_.at(track); }

  bool knows(TrackId track) const { return known_prob_.count(track) > 0; }

  /// Forgets the tracks that ended.
  void forgetEnded();

  /// The next frame has nothing to do with those before.
  void clear();

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  struct Track {
    TrackId id = 0;
    ClassIndex class_index = 0;
    Stamp stamp = 0;
    double driven_m = 0.0;
    int missed = 0;
    int sightings = 1;
    double wander_variance_per_m = 0.0;
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< if it stands
    Eigen::Matrix2d place_cov_m2 = Eigen::Matrix2d::Identity();
    Eigen::Vector4d motion = Eigen::Vector4d::Zero();  ///< position and velocity, if it moves
    Eigen::Matrix4d motion_cov = Eigen::Matrix4d::Identity();
    double log_odds = 0.0;  ///< it moves

    void transfer(StateArchive& archive);
  };

  struct Rate {
    double moving = 0.0;
    double all = 0.0;

    void transfer(StateArchive& archive);
  };

  /// What both models say of a sighting, log densities in 1/m^2.
  struct Likelihoods {
    double standing = 0.0;
    double moving = 0.0;
  };

  Track begun(Stamp stamp, double driven_m, const MovableSighting& sighting);
  Track predicted(const Track& track, Stamp stamp, double driven_m) const;
  std::optional<Likelihoods> compare(const Track& predicted, const MovableSighting& sighting) const;
  /// log density of the next sighting under both.
  static double logDensity(const Likelihoods& likelihoods, double log_odds);
  static void update(const Likelihoods& likelihoods, const MovableSighting& sighting, Track& predicted);
  void endMissed();
  void end(const Track& track);
  double priorProb(ClassIndex class_index) const;

  MovingConfig config_;
  double max_gate_m_;
  std::vector<Rate> rate_of_class_;  ///< of tracks that were long enough to tell
  std::vector<Track> tracks_;
  std::map<TrackId, double> known_prob_;
  TrackId next_id_ = 0;
  AssignmentSolver solver_;
};

}  // namespace semantic_mht_slam
