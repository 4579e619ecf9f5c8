#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/mapping/polar_cells.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

class StateArchive;

/// How the density of clutter is found out while driving.
struct ClutterConfig {
  bool learn = true;
  double prior_detections = 2.0;
};

void describe(ClutterConfig& config, Fields& fields);

/// Where a detection of no known landmark comes from, by class and place round the base: from nothing (clutter), or
/// from an object that is seen for the first time (a birth). Both are Poisson; their rates have Gamma priors, those of
/// a cell round that of its class, that of the class round the configured one. Wrong associations make landmarks of no
/// object, too, which no detector is to blame for: clutter is never taken to be rarer, nor a birth likelier, than
/// configured.
class ClutterModel {
 public:
  /// Before anything is learned `detections_per_frame` of all classes are clutter, uniform over `volume_m3` and the
  /// classes, and a first detection shows an object with probability `birth_prob`. Cells reach to `max_range_m`.
  ClutterModel(const ClutterConfig& config, int class_count, double detections_per_frame, double volume_m3,
               double max_range_m, double birth_prob);

  /// log of the expected number of clutter detections of a class in a frame and a cubic metre at a place of the base
  /// frame.
  double logDensity(ClassIndex class_index, const Eigen::Vector3d& position_m) const;

  /// Probability that a detection there which shows no known landmark shows a new one.
  double birthProb(ClassIndex class_index, const Eigen::Vector3d& position_m) const;

  /// So many frames more were looked at; what they showed follows.
  void addFrames(std::size_t frames);

  /// A detection that is clutter with the first probability and the first of an object with the second.
  void add(ClassIndex class_index, const Eigen::Vector3d& position_m, double clutter_prob, double birth_prob);

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  struct Counts {
    double clutter = 0.0;
    double births = 0.0;

    void transfer(StateArchive& archive);
  };

  std::size_t cellOf(ClassIndex class_index, const Eigen::Vector3d& position_m) const;

  ClutterConfig config_;
  double prior_density_per_m3_;  ///< of one class
  double volume_m3_;
  double max_range_m_;
  double birth_prob_;
  double frames_ = 0.0;
  std::vector<Counts> of_class_;
  std::vector<Counts> of_cell_;  ///< class by class
};

}  // namespace semantic_mht_slam
