#include "semantic_mht_slam/mapping/association.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/log_math.h"

namespace semantic_mht_slam {
namespace {

/// Quantile of the chi-square distribution with 3 degrees of freedom, by bisection of its closed-form distribution
/// function erf(sqrt(x/2)) - sqrt(2x/pi) exp(-x/2).
double chiSquare3Quantile(double prob) {
  double low = 0.0;
  double high = 100.0;
  for (int i = 0; i < 100; ++i) {
    const double x = 0.5 * (low + high);
    const double cdf = std::erf(std::sqrt(0.5 * x)) - std::sqrt(2.0 * x / M_PI) * std::exp(-0.5 * x);
    (cdf < prob ? low : high) = x;
  }
  return 0.5 * (low + high);
}

double wrongClassProb(const AssociationConfig& config) {
  return config.class_model == ClassModel::kDelta ? 0.0 : config.confusion_prob;
}

double logPoisson(int count, double mean) {
  return -mean + count * std::log(mean) - logFactorial(count);
}

}  // namespace

const Candidate* AssociationProblem::candidate(int measurement, int landmark) const {
  for (const Candidate& candidate : gated[static_cast<std::size_t>(measurement)]) {
    if (candidate.landmark == landmark) return &candidate;
  }
  return nullptr;
}

AssociationModel::AssociationModel(const MapperConfig& config, const ClassTable& classes)
    : config_(config),
      class_count_(classes.size()),
      confusion_(classes.size(), wrongClassProb(config.association), config.association.confusion_samples),
      clutter_(config.clutter, classes.size(), config.association.false_positive_density,
               config.association.map_volume_m3, config.detection.max_range_m, config.detection.birth_prob),
      neighbours_(classes.size(), config.association.max_gate_m),
      log_uniform_density_(-std::log(config.association.map_volume_m3) - std::log(static_cast<double>(class_count_))),
      log_inlier_prob_(std::log1p(-config.association.outlier_prob)),
      log_outlier_prob_(std::log(config.association.outlier_prob)),
      gate_mahalanobis_sq_(chiSquare3Quantile(config.association.gate_prob)) {
  for (int count = 0; count <= config_.association.count_prior_cap; ++count) {
    log_count_.push_back(std::log(static_cast<double>(count)));
  }
  if (class_count_ > kMaxClasses) throw std::invalid_argument("more classes than a landmark can hold");
  for (const ClassInfo& info : classes.all()) {
    log_class_prior_.push_back(config_.semantics ? std::log(info.prior_prob) : 0.0);
    const double stddev = info.transition == Transition::kGaussian ? info.transition_stddev_m : 0.0;
    transition_variance_m2_.push_back(stddev * stddev);
  }
}

double AssociationModel::logClassLikelihood(ClassIndex detected, const ClassProbs& probs) const {
  if (!config_.semantics) return -std::log(static_cast<double>(class_count_));
  return std::log((confusion_.likelihoods(detected) * probs).sum());
}

ClassProbs AssociationModel::updatedClassProbs(const ClassProbs& probs, ClassIndex detected) const {
  ClassProbs updated = probs * confusion_.likelihoods(detected);
  const double sum = updated.sum();
  return sum > 0.0 ? ClassProbs(updated / sum) : probs;
}

ClassProbs AssociationModel::initialClassProbs(ClassIndex detected) const {
  return updatedClassProbs(ClassProbs::Constant(class_count_, 1.0 / class_count_), detected);
}

double AssociationModel::logAssignmentPrior(int new_landmarks, int false_positives, int measurements) const {
  return logFactorial(new_landmarks) + logFactorial(false_positives) - logFactorial(measurements) +
         logPoisson(new_landmarks, config_.association.new_density) +
         logPoisson(false_positives, config_.association.false_positive_density);
}

double AssociationModel::logCountPrior(int observations) const {
  const int count = std::clamp(observations, 1, config_.association.count_prior_cap);
  switch (config_.association.count_prior) {
    case CountPrior::kNone:
      return 0.0;
    case CountPrior::kLinear:
      return log_count_[static_cast<std::size_t>(count)];
    case CountPrior::kExponential:
      return static_cast<double>(count);
  }
  throw std::logic_error("unknown count prior");
}

bool AssociationModel::evaluateMixture(const Eigen::Matrix3d& cov, const Eigen::Matrix3d& outlier_cov_m2,
                                       const Eigen::Vector3d& d, Candidate& candidate) const {
  const bool has_outliers = config_.association.outlier_prob > 0.0;
  std::optional<GaussianEvaluation> wide;
  if (has_outliers || config_.association.split_prob > 0.0) {
    Eigen::Matrix3d wide_cov = cov;
    wide_cov += outlier_cov_m2;
    wide = evaluate({Eigen::Vector3d::Zero(), wide_cov}, d);
    if (!wide || (has_outliers && wide->mahalanobis_sq > gate_mahalanobis_sq_)) return false;
    candidate.log_part_likelihood = wide->log_density;
  }
  const auto narrow = evaluate({Eigen::Vector3d::Zero(), cov}, d);
  if (!narrow || (!has_outliers && narrow->mahalanobis_sq > gate_mahalanobis_sq_)) return false;
  candidate.log_likelihood = narrow->log_density;
  if (!has_outliers) return true;
  const double inlier = log_inlier_prob_ + narrow->log_density;
  const double outlier = log_outlier_prob_ + wide->log_density;
  candidate.is_outlier = outlier > inlier;
  candidate.log_likelihood = logAdd(inlier, outlier);
  return true;
}

/// By one axis alone, which no Mahalanobis distance is smaller than; most landmarks go without a factorization.
bool AssociationModel::isSurelyOutsideGate(const Eigen::Matrix3d& cov, const Eigen::Matrix3d& outlier_cov_m2,
                                           const Eigen::Vector3d& d) const {
  Eigen::Array3d variance_m2 = cov.diagonal();
  if (config_.association.outlier_prob > 0.0) variance_m2 += outlier_cov_m2.diagonal().array();
  return (d.array().square() > gate_mahalanobis_sq_ * variance_m2).any();
}

/// Of the difference between a detection with that noise and a landmark.
Eigen::Matrix3d AssociationModel::innovationCov(const TrackedLandmark& landmark, const ObjectNoise& noise,
                                                double driven_m) const {
  Eigen::Matrix3d cov = landmark.position.cov_m2 + noise.cov_m2;
  cov.diagonal().head<2>().array() += noise.wander_variance_per_m * std::abs(driven_m - landmark.updated_at_m);
  if (landmark.is_from_earlier_submap) {
    cov.diagonal().array() += transition_variance_m2_[static_cast<std::size_t>(landmark.mostLikelyClass())];
  }
  return cov;
}

double AssociationModel::distanceSigma(const TrackedLandmark& landmark, const Measurement& measurement,
                                       double driven_m) const {
  const Eigen::Matrix3d cov = innovationCov(landmark, noiseOfObject(measurement, landmark.mostLikelyClass()), driven_m);
  const Eigen::Vector3d d = measurement.position_m - landmark.position.mean_m;
  return std::sqrt(std::max(0.0, d.dot(solved(cov, d))));
}

void AssociationModel::collectReachable(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements,
                                        std::vector<AssociationProblem::Reachable>& reachable) const {
  Eigen::AlignedBox2d reach;
  for (const Measurement& measurement : measurements) reach.extend(measurement.position_m.head<2>());
  const Eigen::Vector2d gate_m = Eigen::Vector2d::Constant(config_.association.max_gate_m);
  if (!measurements.empty()) reach = Eigen::AlignedBox2d(reach.min() - gate_m, reach.max() + gate_m);
  reachable.clear();
  for (std::size_t j = 0; j < hypothesis.landmarks.size(); ++j) {
    const Eigen::Vector3d& position_m = hypothesis.landmarks[j]->position.mean_m;
    if (!reach.contains(position_m.head<2>())) continue;
    reachable.push_back({position_m.x(), position_m.y(), static_cast<int>(j)});
  }
  std::sort(reachable.begin(), reachable.end(),
            [](const auto& a, const auto& b) { return a.x_m != b.x_m ? a.x_m < b.x_m : a.landmark < b.landmark; });
}

void AssociationModel::collectCandidates(const MapHypothesis& hypothesis, const Measurement& detected, double driven_m,
                                         const std::vector<AssociationProblem::Reachable>& reachable,
                                         std::vector<Candidate>& candidates) const {
  candidates.clear();
  std::array<ObjectNoise, kMaxClasses> noise;
  std::bitset<kMaxClasses> is_known;
  const auto noise_of_class = [&](ClassIndex class_index) -> const ObjectNoise& {
    const auto c = static_cast<std::size_t>(class_index);
    if (!is_known[c]) noise[c] = noiseOfObject(detected, class_index);
    is_known.set(c);
    return noise[c];
  };
  const double max_gate_m = config_.association.max_gate_m;
  const double x_begin_m = detected.position_m.x() - max_gate_m;
  const double x_end_m = detected.position_m.x() + max_gate_m;
  auto next = std::lower_bound(reachable.begin(), reachable.end(), x_begin_m,
                               [](const auto& landmark, double x_m) { return landmark.x_m < x_m; });
  for (; next != reachable.end() && next->x_m <= x_end_m; ++next) {
    const int j = next->landmark;
    if (std::abs(detected.position_m.y() - next->y_m) > max_gate_m) continue;
    const TrackedLandmark& landmark = *hypothesis.landmarks[static_cast<std::size_t>(j)];
    const Eigen::Vector3d d = detected.position_m - landmark.position.mean_m;
    const ClassIndex object_class = landmark.mostLikelyClass();
    const ObjectNoise& own = noise_of_class(object_class);
    const Eigen::Matrix3d cov = innovationCov(landmark, own, driven_m);
    if (isSurelyOutsideGate(cov, own.outlier_cov_m2, d)) continue;
    Candidate candidate;
    if (!evaluateMixture(cov, own.outlier_cov_m2, d, candidate)) continue;
    const double log_class = logClassLikelihood(detected.class_index, landmark.class_probs);
    if (!std::isfinite(log_class)) continue;
    candidate.landmark = j;
    candidate.log_likelihood += log_class;
    candidate.log_part_likelihood += log_class;
    candidates.push_back(candidate);
  }
}

void AssociationModel::findCandidates(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements,
                                      double driven_m, AssociationProblem& problem) const {
  problem.landmarks = static_cast<int>(hypothesis.landmarks.size());
  problem.measurements = static_cast<int>(measurements.size());
  problem.gated.resize(measurements.size());
  collectReachable(hypothesis, measurements, problem.reachable);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    collectCandidates(hypothesis, measurements[i], driven_m, problem.reachable, problem.gated[i]);
  }
}

void AssociationModel::formulate(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements,
                                 double driven_m, AssociationProblem& problem) const {
  findCandidates(hypothesis, measurements, driven_m, problem);
  problem.costs.clear(problem.landmarks + 2 * problem.measurements);
  switch (config_.estimator) {
    case Estimator::kDpmhm:
      return addDirichletCosts(hypothesis, problem);
    case Estimator::kMhm:
      return addLikelihoodCosts(measurements, problem);
    case Estimator::kUkf:
      return addDistanceCosts(hypothesis, measurements, problem);
  }
}

void AssociationModel::addDirichletCosts(const MapHypothesis& hypothesis, AssociationProblem& problem) const {
  const AssociationConfig& association = config_.association;
  const double log_new = std::log(association.concentration) + log_uniform_density_;
  const double false_positives =
      hypothesis.false_positives > 0 ? hypothesis.false_positives : association.concentration;
  for (int i = 0; i < problem.measurements; ++i) {
    problem.costs.addRow();
    double log_false = std::log(association.false_positive_rate * false_positives) + log_uniform_density_;
    for (const Candidate& candidate : problem.gated[static_cast<std::size_t>(i)]) {
      const TrackedLandmark& landmark = *hypothesis.landmarks[static_cast<std::size_t>(candidate.landmark)];
      const double log_count = landmark.is_from_earlier_submap ? 0.0 : logCountPrior(landmark.observations);
      problem.costs.add(candidate.landmark, -(log_count + candidate.log_likelihood));
      // A false positive is unlikely where a landmark explains the measurement better than the uniform density does.
      log_false -= std::max(0.0, candidate.log_likelihood - log_uniform_density_);
    }
    problem.costs.add(problem.landmarks + i, -log_new);
    problem.costs.add(problem.landmarks + problem.measurements + i, -log_false);
  }
}

void AssociationModel::addLikelihoodCosts(const std::vector<Measurement>& measurements,
                                          AssociationProblem& problem) const {
  const AssociationConfig& association = config_.association;
  for (int i = 0; i < problem.measurements; ++i) {
    problem.costs.addRow();
    for (const Candidate& candidate : problem.gated[static_cast<std::size_t>(i)]) {
      problem.costs.add(candidate.landmark, -candidate.log_likelihood);
    }
    problem.costs.add(problem.landmarks + i, -(std::log(association.new_density) + log_uniform_density_));
    const double log_clutter = logClutterDensity(measurements[static_cast<std::size_t>(i)]);
    problem.costs.add(problem.landmarks + problem.measurements + i, -log_clutter);
  }
}

void AssociationModel::addDistanceCosts(const MapHypothesis& hypothesis, const std::vector<Measurement>& measurements,
                                        AssociationProblem& problem) const {
  const double gate_m = config_.association.ukf_gate_m;
  for (int i = 0; i < problem.measurements; ++i) {
    const Measurement& measurement = measurements[static_cast<std::size_t>(i)];
    std::vector<Candidate>& gated = problem.gated[static_cast<std::size_t>(i)];
    gated.clear();
    problem.costs.addRow();
    for (int j = 0; j < problem.landmarks; ++j) {
      const TrackedLandmark& landmark = *hypothesis.landmarks[static_cast<std::size_t>(j)];
      const double distance_m = (measurement.position_m - landmark.position.mean_m).norm();
      const bool same_class = !config_.semantics || landmark.mostLikelyClass() == measurement.class_index;
      if (distance_m > gate_m || !same_class) continue;
      gated.push_back({j, 0.0});
      problem.costs.add(j, distance_m);
    }
    problem.costs.add(problem.landmarks + i, gate_m);  // no false positives: what has no neighbour is new
  }
}

}  // namespace semantic_mht_slam
