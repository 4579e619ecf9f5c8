#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/mapping/odometry_learning.h"

// What was learned of the odometry's errors.
namespace semantic_mht_slam {
namespace {

constexpr Eigen::Index kMostErrors = 256;   // of a stretch; some dozens come
constexpr std::size_t kMostStretches = 64;  // ten are kept
constexpr double kLargestLog = 100.0;       // whose exponential is a number
constexpr double kMostDeviations = 1e6;     // of all residuals together, by their own noise
constexpr double kMostEffect = 1e6;         // of a step, and of a class's centroid

/// Whether J^T W r may come of residuals r that were measured, with the information J^T W J: by Cauchy and Schwarz an
/// entry is at most the root of its information times the length of the residuals, in deviations.
bool areOfResiduals(const Eigen::VectorXd& vector, const Eigen::MatrixXd& information) {
  if (vector.size() == 0) return true;
  const double rounding = kRounding * information.diagonal().cwiseAbs().maxCoeff();
  const Eigen::ArrayXd most = kMostDeviations * (information.diagonal().array().max(0.0) + rounding).sqrt();
  return (vector.array().abs() <= most).all();
}

}  // namespace

void ErrorInformation::transfer(StateArchive& archive) {
  archive(matrix, vector, design, effect, coupling, nuisance_matrix, nuisance_vector);
  const Eigen::Index size = vector.size();
  const Eigen::Index nuisances = nuisance_vector.size();
  if (matrix.rows() != size || matrix.cols() != size || design.rows() != size || effect.rows() != size ||
      coupling.rows() != size || coupling.cols() != nuisances || nuisance_matrix.rows() != nuisances ||
      nuisance_matrix.cols() != nuisances) {
    StateArchive::fail("errors of the odometry whose sizes do not fit");
  }
  archive.require(size <= kMostErrors && nuisances <= kMostErrors && (design.array() >= 0.0).all(),
                  "errors of the odometry that are none");
  if (!archive.isReading()) return;
  Eigen::MatrixXd all(size + nuisances, size + nuisances);
  all << matrix, coupling, coupling.transpose(), nuisance_matrix;
  archive.require(isNotNegative(all), "errors of the odometry whose information is negative");
  archive.require(areOfResiduals(vector, matrix) && areOfResiduals(nuisance_vector, nuisance_matrix),
                  "errors of the odometry that no residuals give");
}

void VarianceComponents::transfer(StateArchive& archive) {
  const Eigen::Index parts = prior_mean_.size();
  const Eigen::Index effects = effect_.size();
  archive(prior_mean_, prior_precision_, effect_information_, effect_vector_, stretches_);
  archive(log_variance_, log_uncertainty_, effect_, effect_cov_);
  bool fits = prior_mean_.size() == parts && prior_precision_.rows() == parts && prior_precision_.cols() == parts &&
              log_variance_.size() == parts && log_uncertainty_.size() == parts && log_variance_.allFinite() &&
              effect_.size() == effects && effect_vector_.size() == effects && effect_information_.rows() == effects &&
              effect_information_.cols() == effects && effect_cov_.rows() == effects && effect_cov_.cols() == effects;
  for (const ErrorInformation& stretch : stretches_) {
    fits = fits && stretch.design.cols() == parts && stretch.effect.cols() + stretch.coupling.cols() == effects;
  }
  if (!fits) StateArchive::fail("errors of the odometry in other parts");
  archive.require(isPositive(prior_precision_) && isNotNegative(effect_information_) && isNotNegative(effect_cov_),
                  "errors of the odometry whose precision is not positive");
  archive.require(areOfResiduals(effect_vector_, effect_information_), "errors of the odometry that no residuals give");
  archive.require(log_variance_.cwiseAbs().maxCoeff() <= kLargestLog && log_uncertainty_.minCoeff() >= 0.0 &&
                      (effect_.array().abs() <= kMostEffect).all(),
                  "errors of the odometry beyond any");
  archive.require(stretches_.size() <= kMostStretches, "more errors of the odometry than are kept");
}

void OdometryLearning::transfer(StateArchive& archive) {
  archive(planar_, vertical_);
  if (archive.isReading() && config_.learn) readOff();
}

}  // namespace semantic_mht_slam
