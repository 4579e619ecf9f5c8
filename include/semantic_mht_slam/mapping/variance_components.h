#pragma once

#include <deque>
#include <vector>

#include <Eigen/Core>

namespace semantic_mht_slam {

class StateArchive;

/// Information on errors e that nobody has observed directly, and on nuisances n of whatever observed them, in form of
/// a likelihood: exp(-e' matrix e / 2 + e' (vector - coupling n) - n' nuisance_matrix n / 2 + nuisance_vector' n). Each
/// component of the errors' variance is variance[i] * design.col(i), row by row.
struct ErrorInformation {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd vector;
  Eigen::MatrixXd design;  ///< not negative; a row an error
  Eigen::MatrixXd effect;  ///< what the errors have in common: their mean is effect * coefficients
  Eigen::MatrixXd coupling;
  Eigen::MatrixXd nuisance_matrix;
  Eigen::VectorXd nuisance_vector;

  void transfer(StateArchive& archive);
};

/// Variances of the parts that independent normal errors are made of, and coefficients that all errors share, from what
/// is known of stretches of errors one after the other: a mixed linear model. Marginal likelihood over the errors with
/// log-normal priors of the variances, by Fisher scoring (Searle, Casella, McCulloch, Variance Components, 1992,
/// chapter 6), errors beyond three deviations weighed down; the newest stretches are gone through again each time, of
/// the older ones a quadratic form in the logarithms is kept.
class VarianceComponents {
 public:
  /// Priors: the standard deviations of the parts, each known within a factor exp(`log_stddev`), and those of the
  /// coefficients about zero, the nuisances last.
  VarianceComponents(const Eigen::VectorXd& prior_stddev, double log_stddev, const Eigen::VectorXd& effect_stddev);

  /// Takes a stretch. One that has no solution is left out.
  void add(ErrorInformation stretch);

  /// The standard deviations of the parts, as far up as they are unsure.
  Eigen::VectorXd stddev() const;

  /// The coefficients, with the nuisances, and their covariance.
  const Eigen::VectorXd& effect() const { return effect_; }
  const Eigen::MatrixXd& effectCov() const { return effect_cov_; }

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  /// Gradient and Fisher information of a stretch's log likelihood in the logarithms of the variances, and what it says
  /// of the coefficients.
  struct Score {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd fisher;
    Eigen::MatrixXd effect_information;
    Eigen::VectorXd effect_vector;
  };

  bool score(const ErrorInformation& stretch, Score& score) const;
  void fit();
  void forgetOldest();

  Eigen::VectorXd prior_mean_;       ///< of the logarithms of the variances, with what was forgotten
  Eigen::MatrixXd prior_precision_;  ///< of these
  Eigen::MatrixXd effect_information_;
  Eigen::VectorXd effect_vector_;
  std::deque<ErrorInformation> stretches_;
  Eigen::VectorXd log_variance_;
  Eigen::VectorXd log_uncertainty_;  ///< variance of `log_variance_`
  Eigen::VectorXd effect_;
  Eigen::MatrixXd effect_cov_;
};

}  // namespace semantic_mht_slam
