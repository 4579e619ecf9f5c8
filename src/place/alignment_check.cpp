#include "alignment_check.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace semantic_mht_slam {
namespace {

double largestHorizontalStddev(const Eigen::Matrix<double, 6, 6>& cov) {
  const Eigen::Matrix2d horizontal = cov.topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(horizontal, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(1)));
}

}  // namespace

PlaceRefusal checkAlignment(const SceneAlignment& alignment, double rival_score, const PlaceConfig& config) {
  if (static_cast<int>(alignment.pairs.size()) < config.min_inliers) return PlaceRefusal::kFewInliers;
  if (alignment.pair_classes < config.min_classes) return PlaceRefusal::kFewClasses;
  if (alignment.spread_m < config.min_spread_m) return PlaceRefusal::kOnALine;
  if (largestHorizontalStddev(alignment.cov) > config.max_stddev_m ||
      std::sqrt(alignment.cov(5, 5)) > config.max_stddev_rad) {
    return PlaceRefusal::kUncertain;
  }
  if (alignment.similarity < config.supported_score ||
      alignment.similarity < config.min_share * alignment.soft_inliers ||
      alignment.log_evidence < config.min_log_evidence) {
    return PlaceRefusal::kLowScore;
  }
  if (rival_score > config.rival_ratio * alignment.similarity) return PlaceRefusal::kAmbiguous;
  return PlaceRefusal::kNone;
}

}  // namespace semantic_mht_slam
