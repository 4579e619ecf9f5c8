#pragma once

#include <vector>

#include "semantic_mht_slam/common/assignment.h"
#include "semantic_mht_slam/mapping/class_confusion.h"
#include "semantic_mht_slam/mapping/clutter_model.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/mapper_config.h"
#include "semantic_mht_slam/mapping/neighbour_density.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// A landmark inside the gate of a measurement.
struct Candidate {
  int landmark = 0;             ///< index in the hypothesis
  double log_likelihood = 0.0;  ///< log N(p; pi, P + Sigma) + log P(c | class probabilities), 1/m^3
  bool is_outlier = false;      ///< better explained by a centroid that is far off
  /// As `log_likelihood`, of a part of the object, whose centroid is far off.
  double log_part_likelihood = 0.0;
};

/// What the association of one frame with one hypothesis has to choose from.
/// Columns of the costs: landmark j is column j, measurement i as new landmark is column L + i, as false positive
/// L + R + i (L landmarks, R measurements).
struct AssociationProblem {
  SparseCostMatrix costs;                     ///< negative log-likelihoods of the four cases, nats
  std::vector<std::vector<Candidate>> gated;  ///< of each measurement
  int landmarks = 0;
  int measurements = 0;

  /// A landmark near enough to the measurements to be a candidate of any.
  struct Reachable {
    double x_m;
    double y_m;
    int landmark;
  };
  std::vector<Reachable> reachable;  ///< by rising x

  bool isLandmark(int column) const { return column < landmarks; }
  bool isNew(int column) const { return column >= landmarks && column < landmarks + measurements; }

  /// The candidate of a measurement behind a landmark column; nullptr if it is outside the gate.
  const Candidate* candidate(int measurement, int landmark) const;
};

/// Likelihoods of associations: the four cases of the paper's section II-A and the weight of its equations 1 to 3.
class AssociationModel {
 public:
  AssociationModel(const MapperConfig& config, const ClassTable& classes);

  /// Fills `problem`, whose memory is used again. The order of measurements and landmarks does not change the result
  /// but for the order of rows and columns.
  void formulate(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements, double driven_m,
                 AssociationProblem& problem) const;

  /// The part of that which tells what landmarks are in the gate of each measurement.
  void findCandidates(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements, double driven_m,
                      AssociationProblem& problem) const;

  /// Mahalanobis distance between a measurement and a landmark.
  double distanceSigma(const TrackedLandmark& landmark, const Measurement& measurement, double driven_m) const;

  /// log g(N), by which a landmark with so many detections is preferred.
  double logCountPrior(int observations) const;

  /// log P(detected class | class probabilities).
  double logClassLikelihood(ClassIndex detected, const ClassProbs& probs) const;

  /// Class probabilities after a detection of that class (Bayes).
  ClassProbs updatedClassProbs(const ClassProbs& probs, ClassIndex detected) const;

  /// Class probabilities of a landmark that was seen once.
  ClassProbs initialClassProbs(ClassIndex detected) const;

  /// log of the assignment prior N^n! N^f! / N^m! Poisson(N^n) Poisson(N^f) (paper eq. 3, with exp(-lambda V)).
  double logAssignmentPrior(int new_landmarks, int false_positives, int measurements) const;

  /// log p_s of a class (paper eq. 2).
  double logClassPrior(ClassIndex detected) const { return log_class_prior_[static_cast<std::size_t>(detected)]; }

  /// How classes are confused, as it is known now.
  ClassConfusion& confusion() { return confusion_; }

  /// log density of a detection that may be of any class and anywhere in the map's volume, 1/m^3.
  double logUniformDensity() const { return log_uniform_density_; }

  /// How often detections show nothing, as it is known now.
  ClutterModel& clutter() { return clutter_; }

  /// How densely objects of a class stand, as it is known now.
  NeighbourDensity& neighbours() { return neighbours_; }
  const NeighbourDensity& neighbours() const { return neighbours_; }

  /// log of the expected number of false positives of its class in a frame and a cubic metre where a measurement is.
  double logClutterDensity(const Measurement& measurement) const {
    return clutter_.logDensity(measurement.class_index, measurement.ray_m);
  }

  /// Existence probability of a landmark that a measurement begins.
  double birthProb(const Measurement& measurement) const {
    return clutter_.birthProb(measurement.class_index, measurement.ray_m);
  }

 private:
  void collectReachable(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements,
                        std::vector<AssociationProblem::Reachable>& reachable) const;
  void collectCandidates(const MapHypothesis& hypothesis, const Measurement& detected, double driven_m,
                         const std::vector<AssociationProblem::Reachable>& reachable,
                         std::vector<Candidate>& candidates) const;
  bool isSurelyOutsideGate(const Eigen::Matrix3d& cov, const Eigen::Matrix3d& outlier_cov_m2,
                           const Eigen::Vector3d& d) const;
  /// Fills all of a candidate but the landmark and what its class says; false: outside the gate.
  bool evaluateMixture(const Eigen::Matrix3d& cov, const Eigen::Matrix3d& outlier_cov_m2, const Eigen::Vector3d& d,
                       Candidate& candidate) const;
  Eigen::Matrix3d innovationCov(const TrackedLandmark& landmark, const ObjectNoise& noise, double driven_m) const;
  void addDirichletCosts(const MapHypothesis& hypothesis, AssociationProblem& problem) const;
  void addLikelihoodCosts(const std::vector<Measurement>& measurements, AssociationProblem& problem) const;
  void addDistanceCosts(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements,
                        AssociationProblem& problem) const;

  MapperConfig config_;
  int class_count_;
  ClassConfusion confusion_;
  ClutterModel clutter_;
  NeighbourDensity neighbours_;
  std::vector<double> log_class_prior_;
  std::vector<double> log_count_;  ///< by count, up to the largest that matters
  std::vector<double> transition_variance_m2_;
  double log_uniform_density_;
  double log_inlier_prob_;
  double log_outlier_prob_;  ///< -infinity: no centroids are far off
  double gate_mahalanobis_sq_;
};

}  // namespace semantic_mht_slam
