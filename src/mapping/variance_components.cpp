#include "semantic_mht_slam/mapping/variance_components.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "semantic_mht_slam/common/dense_solvers.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kStretches = 10;  // that are gone through again
constexpr int kMostPasses = 4;
constexpr double kSettled = 0.01;  // standard deviations; a smaller step is the last
constexpr double kLargestStep = 1.0;
constexpr double kMostErrorDeviations = 3.0;  // of an error from what the others make of it
constexpr double kLeastComponentVariance = 1e-14;
constexpr double kMostUnsure = 1.0;  // variance of a logarithm that adds to the variance itself

}  // namespace

VarianceComponents::VarianceComponents(const Eigen::VectorXd& prior_stddev, double log_stddev,
                                       const Eigen::VectorXd& effect_stddev)
    : prior_mean_(2.0 * prior_stddev.array().log()),
      prior_precision_(Eigen::MatrixXd::Identity(prior_stddev.size(), prior_stddev.size()) /
                       (4.0 * log_stddev * log_stddev)),
      effect_information_(effect_stddev.cwiseAbs2().cwiseInverse().asDiagonal()),
      effect_vector_(Eigen::VectorXd::Zero(effect_stddev.size())),
      log_variance_(prior_mean_),
      log_uncertainty_(Eigen::VectorXd::Zero(prior_stddev.size())),
      effect_(effect_vector_),
      effect_cov_(effect_stddev.cwiseAbs2().asDiagonal()) {}

void VarianceComponents::add(ErrorInformation stretch) {
  if (stretch.vector.size() == 0) return;
  Score unused;
  if (!score(stretch, unused)) return;
  stretches_.push_back(std::move(stretch));
  fit();
  if (stretches_.size() > kStretches) forgetOldest();
}

bool VarianceComponents::score(const ErrorInformation& stretch, Score& score) const {
  const Eigen::MatrixXd& H = stretch.matrix;
  const Eigen::VectorXd variance =
      (stretch.design * log_variance_.array().exp().matrix()).cwiseMax(kLeastComponentVariance);
  Eigen::MatrixXd posterior = H;
  posterior.diagonal() += variance.cwiseInverse();
  const auto factor = choleskyOf(posterior);
  if (!factor) return false;
  // Precision of what was measured of the errors, V^-1 = H - H (H + Q^-1)^-1 H, and V^-1 y.
  const Eigen::MatrixXd whitened = factor->matrixL().solve(H);
  Eigen::MatrixXd V_inverse = H;
  V_inverse.noalias() -= whitened.transpose() * whitened;
  const Eigen::VectorXd V_inverse_y = stretch.vector - H * factor->solve(stretch.vector);
  // What a unit of each coefficient adds to V^-1 y, and what they are known by.
  const Eigen::Index effects = stretch.effect.cols();
  const Eigen::Index nuisances = stretch.coupling.cols();
  const Eigen::MatrixXd solved = nuisances > 0 ? factor->solve(stretch.coupling).eval() : stretch.coupling;
  Eigen::MatrixXd response(H.rows(), effects + nuisances);
  response.leftCols(effects) = V_inverse * stretch.effect;
  response.rightCols(nuisances) = stretch.coupling - H * solved;
  const Eigen::VectorXd u = V_inverse_y - response * effect_;
  const Eigen::MatrixXd parts = stretch.design * log_variance_.array().exp().matrix().asDiagonal();
  const Eigen::VectorXd most = kMostErrorDeviations * kMostErrorDeviations * V_inverse.diagonal().cwiseMax(0.0);
  score.gradient = 0.5 * parts.transpose() * (u.cwiseAbs2().cwiseMin(most) - V_inverse.diagonal());
  score.fisher = 0.5 * parts.transpose() * V_inverse.cwiseAbs2() * parts;
  score.effect_information.resize(effects + nuisances, effects + nuisances);
  score.effect_information.topRows(effects) = stretch.effect.transpose() * response;
  score.effect_information.bottomLeftCorner(nuisances, effects) =
      score.effect_information.topRightCorner(effects, nuisances).transpose();
  score.effect_information.bottomRightCorner(nuisances, nuisances) =
      stretch.nuisance_matrix - stretch.coupling.transpose() * solved;
  score.effect_vector.resize(effects + nuisances);
  score.effect_vector.head(effects) = stretch.effect.transpose() * V_inverse_y;
  score.effect_vector.tail(nuisances) =
      stretch.nuisance_vector - stretch.coupling.transpose() * factor->solve(stretch.vector);
  return score.gradient.allFinite() && score.fisher.allFinite() && score.effect_vector.allFinite();
}

void VarianceComponents::fit() {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    Eigen::VectorXd gradient = prior_precision_ * (prior_mean_ - log_variance_);
    Eigen::MatrixXd fisher = prior_precision_;
    Eigen::MatrixXd effect_information = effect_information_;
    Eigen::VectorXd effect_vector = effect_vector_;
    for (const ErrorInformation& stretch : stretches_) {
      Score of;
      if (!score(stretch, of)) continue;
      gradient += of.gradient;
      fisher += of.fisher;
      effect_information += of.effect_information;
      effect_vector += of.effect_vector;
    }
    const Eigen::MatrixXd uncertainty = inverted(fisher);
    const Eigen::VectorXd step = uncertainty * gradient;
    log_variance_ += step / std::max(1.0, step.cwiseAbs().maxCoeff() / kLargestStep);
    log_uncertainty_ = uncertainty.diagonal();
    if (effect_.size() > 0) {
      effect_cov_ = inverted(effect_information);
      effect_ = effect_cov_ * effect_vector;
    }
    if ((step.array().square() <= kSettled * kSettled * uncertainty.diagonal().array()).all()) return;
  }
}

/// The oldest stretch becomes part of the priors.
void VarianceComponents::forgetOldest() {
  Score of;
  if (score(stretches_.front(), of)) {
    const Eigen::VectorXd vector = prior_precision_ * prior_mean_ + of.fisher * log_variance_ + of.gradient;
    prior_precision_ += of.fisher;
    prior_mean_ = inverted(prior_precision_) * vector;
    effect_information_ += of.effect_information;
    effect_vector_ += of.effect_vector;
  }
  stretches_.pop_front();
}

Eigen::VectorXd VarianceComponents::stddev() const {
  const Eigen::VectorXd upwards = 0.5 * log_uncertainty_.cwiseMin(kMostUnsure);
  return (0.5 * (log_variance_ + upwards)).array().exp();
}

}  // namespace semantic_mht_slam
