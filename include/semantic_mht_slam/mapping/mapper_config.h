#pragma once

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/mapping/centroid_bias.h"
#include "semantic_mht_slam/mapping/clutter_model.h"
#include "semantic_mht_slam/mapping/detection_rate.h"
#include "semantic_mht_slam/mapping/detector_calibration.h"
#include "semantic_mht_slam/mapping/duplicate_merging.h"
#include "semantic_mht_slam/mapping/earlier_map.h"
#include "semantic_mht_slam/mapping/moving_objects.h"
#include "semantic_mht_slam/mapping/odometry_learning.h"

namespace semantic_mht_slam {

/// How hypotheses are made and weighed.
enum class Estimator {
  kDpmhm,  ///< Dirichlet-process association, KLD resampling (the paper's method)
  kMhm,    ///< maximum likelihood association, the best third is kept when the tree exceeds its size
  kUkf,    ///< one hypothesis, Hungarian assignment on Euclidean distances
};

enum class CountPrior { kNone, kLinear, kExponential };
enum class ClassModel { kDelta, kConfusion };
enum class MeasurementModel {
  kAdditive,      ///< position with additive noise (the paper)
  kRangeBearing,  ///< range, bearing and elevation from a sensor whose position is uncertain
};

/// Likelihoods of the four cases of an association (paper, section II-A) and the gate.
struct AssociationConfig {
  double gate_prob = 0.999;
  Length max_gate_m{6.0};
  CountPrior count_prior = CountPrior::kLinear;
  int count_prior_cap = 20;
  double concentration = 100.0;
  double false_positive_rate = 0.001;
  Length map_volume_m3{30000.0, 2};
  ClassModel class_model = ClassModel::kConfusion;
  double confusion_prob = 0.1;
  double confusion_samples = 100.0;
  bool learn_confusion = true;
  double new_density = 1.0;
  double false_positive_density = 1.0;
  double outlier_prob = 0.1;
  double outlier_factor = 3.0;
  Length outlier_min_stddev_m{0.3};
  Length ukf_gate_m{2.0};
  double split_prob = 0.015;
};

/// The hypothesis tree (paper, section II-B).
struct TreeConfig {
  int max_hypotheses = 30;
  int max_branches = 4;
  double branch_log_ratio = 3.0;
  double ess_ratio = 0.5;
  double kld_epsilon = 0.05;
  double kld_delta = 0.1;
  double min_weight = 0.08;
};

/// How long a submap lives.
struct SubmapConfig {
  Length length_m{30.0};
  double turn_rad = 6.3;
  int max_frames = 600;
  bool correct_pose = true;
  Length propagation_m{120.0};
};

/// Everything that the mapper needs.
struct MapperConfig {
  Estimator estimator = Estimator::kDpmhm;
  bool semantics = true;
  MeasurementModel measurement_model = MeasurementModel::kAdditive;
  AssociationConfig association;
  DetectionConfig detection;
  ClutterConfig clutter;
  MovingConfig moving;
  TreeConfig tree;
  SubmapConfig submap;
  OdometryConfig odometry;
  CalibrationConfig calibration;
  BiasConfig bias;
  MapAlignmentConfig alignment;
  DuplicateConfig duplicates;
};

/// The defaults that belong to an estimator. The baselines are those of the paper: they have neither the Dirichlet
/// process's count prior nor what goes beyond the paper (pose correction, heavy tails, split objects, merging of
/// duplicates, centroid bias, learned confusion of classes and density of clutter, alignment with an earlier map); each
/// of these can be switched on for them by its own key.
MapperConfig defaultsOf(Estimator estimator);

void describe(AssociationConfig& config, Fields& fields);
void describe(TreeConfig& config, Fields& fields);
void describe(SubmapConfig& config, Fields& fields);
void describe(MapperConfig& config, Fields& fields);

}  // namespace semantic_mht_slam
