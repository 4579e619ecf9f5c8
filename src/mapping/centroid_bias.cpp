#include "semantic_mht_slam/mapping/centroid_bias.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/dense_solvers.h"

#include "bias_equations.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMinPriorStddev_m = 0.05;
constexpr double kStepFactor = 0.25;  // a change of bias from knot to knot, in range_stddev of the class
constexpr double kLeastDirectionRange_m = 0.1;

void addStepPrior(Eigen::MatrixXd& information, int a, int b, double stddev) {
  const double weight = 1.0 / (stddev * stddev);
  information(a, a) += weight;
  information(b, b) += weight;
  information(a, b) -= weight;
  information(b, a) -= weight;
}

/// A level around zero and steps from knot to knot, which are smaller: what a centroid is off by is the size of the
/// object, from wherever it is seen. In the height only steps.
void addClassPrior(Eigen::MatrixXd& information, const BiasLayout& layout, ClassIndex c, double level_stddev_m,
                   double step_stddev_m, double height_stddev_m) {
  for (int knot = 0; knot < BiasLayout::kRangeKnots; ++knot) {
    information(layout.range(c, knot), layout.range(c, knot)) += 1.0 / (level_stddev_m * level_stddev_m);
  }
  for (int knot = 1; knot < BiasLayout::kRangeKnots; ++knot) {
    addStepPrior(information, layout.range(c, knot - 1), layout.range(c, knot), step_stddev_m);
  }
  information(layout.height(c, 1), layout.height(c, 1)) += 1.0 / (height_stddev_m * height_stddev_m);
  for (int knot = 2; knot < BiasLayout::kRangeKnots; ++knot) {
    addStepPrior(information, layout.height(c, knot - 1), layout.height(c, knot), height_stddev_m);
  }
}

BiasInformation ordered(const BiasInformation& information, const std::vector<int>& order) {
  const auto size = static_cast<Eigen::Index>(order.size());
  BiasInformation result{Eigen::MatrixXd(size, size), Eigen::VectorXd(size)};
  for (Eigen::Index a = 0; a < size; ++a) {
    for (Eigen::Index b = 0; b < size; ++b) result.matrix(a, b) = information.matrix(order[a], order[b]);
    result.vector[a] = information.vector[order[a]];
  }
  return result;
}

}  // namespace

void describe(BiasConfig& config, Fields& fields) {
  fields.add("enabled", config.enabled, "false: centroids are taken to be unbiased (the paper).");
  fields.add("prior_factor", config.prior_factor, "", {0.01, 100.0},
             "Deviation of the bias along the line of sight before anything is known, in range_stddev of the class.");
  fields.add("height_stddev", config.height_stddev_m, "m", {1e-3, 10.0},
             "Deviation of the change of height over 10 m of range before anything is known.");
  fields.add("scale_stddev", config.scale_stddev, "", {1e-4, 1.0},
             "Deviation of the odometry's scale, and of its direction against the sensor's axes in rad.");
  fields.add("scale_change_stddev", config.scale_change_stddev, "", {1e-4, 1.0},
             "The same for what differs from submap to submap.");
  fields.add("min_observations", config.min_observations, "", {2, 1000},
             "Landmarks seen less often in a submap say nothing.");
}

CentroidBias::CentroidBias(const BiasConfig& config, const ClassTable& classes) : config_(config) {
  for (const ClassInfo& info : classes.all()) {
    stddev_m_.push_back(std::max(kMinPriorStddev_m, info.range_stddev_m));
    const bool has_bias = info.transition == Transition::kDirac || info.transition_stddev_m <= info.range_stddev_m;
    place_.push_back(has_bias ? biased_count_++ : -1);
    has_one_place_.push_back(has_bias && info.is_static);
  }
  forget();
}

void CentroidBias::forget() {
  const BiasLayout layout{biased_count_};
  information_ = Eigen::MatrixXd::Zero(layout.size(), layout.size());
  vector_ = Eigen::VectorXd::Zero(layout.size());
  for (std::size_t c = 0; c < place_.size(); ++c) {
    if (place_[c] < 0) continue;
    addClassPrior(information_, layout, place_[c], config_.prior_factor * stddev_m_[c], kStepFactor * stddev_m_[c],
                  config_.height_stddev_m);
  }
  for (int i = 0; i < BiasLayout::kMotion; ++i) {
    information_(layout.motion(i), layout.motion(i)) += 1.0 / (config_.scale_stddev * config_.scale_stddev);
  }
  solve();
}

void CentroidBias::add(const BiasStretch& stretch, const OdometryNoise& odometry) {
  if (!config_.enabled || stretch.T_stretch_base.size() < 2) return;
  const BiasLayout layout{biased_count_};
  const BiasMotionNoise noise{odometry, config_.scale_change_stddev, config_.min_observations};
  BiasStretch used{stretch.T_stretch_base, {}};
  for (const BiasObservation& observation : stretch.observations) {
    const int place = place_[static_cast<std::size_t>(observation.class_index)];
    if (place < 0) continue;
    used.observations.push_back(observation);
    used.observations.back().class_index = place;
  }
  const BiasInformation before{information_, vector_};
  const BiasInformation more = biasInformation(used, layout, noise, before);
  if (!more.matrix.allFinite() || !more.vector.allFinite()) return;
  information_ += more.matrix;
  vector_ += more.vector;
  if (solve()) return;
  information_ = before.matrix;
  vector_ = before.vector;
}

void CentroidBias::adopt(const std::vector<int>& place, const Eigen::MatrixXd& information,
                         const Eigen::VectorXd& vector) {
  forget();
  const BiasLayout ours{biased_count_};
  const BiasLayout theirs{static_cast<int>(std::count_if(place.begin(), place.end(), [](int p) { return p >= 0; }))};
  std::vector<int> order;      // their coefficients: first those that are ours, too
  std::vector<int> our_place;  // of these
  std::vector<int> gone;       // those of classes that have no bias any more
  for (std::size_t c = 0; c < place_.size(); ++c) {
    for (int i = 0; i < BiasLayout::kPerClass && place[c] >= 0; ++i) {
      (place_[c] < 0 ? gone : order).push_back(theirs.range(place[c], 0) + i);
      if (place_[c] >= 0) our_place.push_back(ours.range(place_[c], 0) + i);
    }
  }
  for (int i = 0; i < BiasLayout::kMotion; ++i) {
    order.push_back(theirs.motion(i));
    our_place.push_back(ours.motion(i));
  }
  order.insert(order.end(), gone.begin(), gone.end());
  const BiasInformation kept = marginal(ordered({information, vector}, order), static_cast<int>(our_place.size()));
  for (std::size_t a = 0; a < our_place.size(); ++a) {
    for (std::size_t b = 0; b < our_place.size(); ++b) information_(our_place[a], our_place[b]) = kept.matrix(a, b);
    vector_[our_place[a]] = kept.vector[a];
  }
}

/// False, and the solution stays as it was, if the information has none.
bool CentroidBias::solve() {
  const auto factor = choleskyOf(information_);
  if (!factor) return false;
  cov_ = factor->solve(Eigen::MatrixXd::Identity(information_.rows(), information_.cols()));
  mean_ = cov_ * vector_;
  return true;
}

CentroidBiasEstimate CentroidBias::at(ClassIndex class_index, double range_m) const {
  CentroidBiasEstimate result;
  const int place = place_[static_cast<std::size_t>(class_index)];
  if (!config_.enabled || place < 0) return result;
  const BiasLayout layout{biased_count_};
  const BiasBasis basis = biasBasis(range_m);
  const double a = basis.near_share;
  const double b = basis.far_share;
  const int last = std::min(basis.knot + 1, BiasLayout::kRangeKnots - 1);
  const int i = layout.range(place, basis.knot);
  const int j = layout.range(place, last);
  result.range_m = a * mean_[i] + b * mean_[j];
  result.range_variance_m2 = a * a * cov_(i, i) + 2.0 * a * b * cov_(i, j) + b * b * cov_(j, j);
  const int v = layout.height(place, last);
  result.height_m = b * mean_[v];
  result.height_variance_m2 = b * b * cov_(v, v);
  if (basis.knot > 0) {
    const int u = layout.height(place, basis.knot);
    result.height_m += a * mean_[u];
    result.height_variance_m2 += a * a * cov_(u, u) + 2.0 * a * b * cov_(u, v);
  }
  return result;
}

Eigen::Matrix3d CentroidBias::uncertainty(ClassIndex class_index, const Eigen::Vector3d& position_m) const {
  const double range_m = position_m.norm();
  if (!config_.enabled || range_m < kLeastDirectionRange_m) return Eigen::Matrix3d::Zero();
  const CentroidBiasEstimate bias = at(class_index, range_m);
  const Eigen::Vector3d ray = position_m / range_m;
  const double stddev_m = stddev_m_[static_cast<std::size_t>(class_index)];
  const double max_variance_m2 = stddev_m * stddev_m;
  Eigen::Matrix3d cov = std::min(bias.range_variance_m2, max_variance_m2) * ray * ray.transpose();
  cov(2, 2) += std::min(bias.height_variance_m2, max_variance_m2);
  return cov;
}

Detection CentroidBias::corrected(const Detection& detection) const {
  const double range_m = detection.position_m.norm();
  if (!config_.enabled || range_m < kLeastDirectionRange_m) return detection;
  const CentroidBiasEstimate bias = at(detection.class_index, range_m);
  Detection result = detection;
  result.position_m *= std::max(kLeastDirectionRange_m, range_m - bias.range_m) / range_m;
  result.position_m.z() -= bias.height_m;
  if (detection.cov_m2) result.cov_m2 = *detection.cov_m2 + uncertainty(detection.class_index, detection.position_m);
  return result;
}

double CentroidBias::odometryScale() const {
  return mean_[BiasLayout{biased_count_}.motion(0)];
}

double CentroidBias::scaleStddev() const {
  const int scale = BiasLayout{biased_count_}.motion(0);
  return config_.enabled ? std::sqrt(cov_(scale, scale)) : 0.0;
}

}  // namespace semantic_mht_slam
