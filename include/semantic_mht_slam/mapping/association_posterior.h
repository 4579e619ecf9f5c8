#pragma once

#include <utility>
#include <vector>

#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/mapping/association.h"
#include "semantic_mht_slam/mapping/detection_rate.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/mapper_config.h"
#include "semantic_mht_slam/mapping/unsure_detections.h"

namespace semantic_mht_slam {

/// What a measurement may be of.
struct AssociationOdds {
  int landmark = 0;   ///< index
  double sole = 0.0;  ///< odds against clutter that it is the detection of the landmark in this frame
  double part = 0.0;  ///< odds against clutter that it is a further part of the landmark
};

/// Probability that each measurement of a frame is of each of its landmarks, in the order of `odds`; a landmark has one
/// detection a frame, and may have parts. What is left is clutter. Belief propagation on the graph of measurements and
/// landmarks (Williams and Lau, "Approximate evaluation of marginal association probabilities with belief propagation",
/// IEEE TAES 2014), which is exact where it has no loop.
std::vector<std::vector<double>> associationMarginals(const std::vector<std::vector<AssociationOdds>>& odds,
                                                      int landmarks);

/// The association of one measurement as all frames of a submap have it.
struct JudgedAssociation {
  double own_prob = 0.0;      ///< that it is of its landmark, if that exists
  double nothing_prob = 0.0;  ///< that it is of nothing
};

/// Which landmarks the measurements of a finished submap are of, by where these turned out to be and whether they
/// exist: what the hypotheses could not know when they took each frame in, clutter among it.
class AssociationPosterior {
 public:
  /// `landmarks` in the submap frame, with the way driven to where each was seen last. All must outlive it.
  AssociationPosterior(const MapperConfig& config, const AssociationModel& model, const DetectionRate& rate,
                       std::vector<std::pair<MixtureLandmark, double>> landmarks);

  /// Measurements of a frame in the submap frame, and the landmark that each was assigned to.
  std::vector<JudgedAssociation> judge(const std::vector<Measurement>& measurements, double driven_m,
                                       const std::vector<LandmarkId>& assigned);

  /// What a measurement of the frame that was judged last may be of, nothing included, by falling probability; less
  /// than half a thousandth is left out.
  std::vector<AssociationAlternative> alternatives(std::size_t index, const Measurement& measurement,
                                                   double driven_m) const;

 private:
  double detectionProb(const Measurement& measurement, const HypothesisLandmark& landmark) const;
  double expectedProb(const Measurement& measurement, const HypothesisLandmark& landmark, bool is_own) const;
  double oddsFarOff(const Measurement& measurement, const HypothesisLandmark& landmark) const;
  void findOdds(const std::vector<Measurement>& measurements, const std::vector<LandmarkId>& assigned);
  bool isGiven(const HypothesisLandmark& landmark, LandmarkId assigned) const;
  double probOf(std::size_t measurement, std::size_t choice) const;
  AssociationOdds oddsOf(const Measurement& measurement, const Candidate& candidate, bool is_own) const;

  const MapperConfig& config_;
  const AssociationModel& model_;
  const DetectionRate& rate_;
  MapHypothesis map_;
  AssociationProblem problem_;
  // Of the frame that was judged last, by measurement:
  std::vector<LandmarkId> assigned_;
  std::vector<std::vector<AssociationOdds>> odds_;
  std::vector<std::vector<double>> marginals_;
};

}  // namespace semantic_mht_slam
