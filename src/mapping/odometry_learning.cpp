#include "semantic_mht_slam/mapping/odometry_learning.h"

#include <cmath>
#include <utility>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

enum PlanarPart { kAlong, kAcross, kHeadingByWay, kHeadingByTurn, kPlanarParts };
enum VerticalPart { kUp, kTilt, kVerticalParts };

Eigen::VectorXd planarStddev(const OdometryNoise& noise) {
  return Eigen::Vector4d(noise.along_m_per_sqrt_m, noise.across_m_per_sqrt_m, noise.heading_rad_per_sqrt_m,
                         noise.heading_rad_per_sqrt_rad);
}

Eigen::VectorXd verticalStddev(const OdometryNoise& noise) {
  return Eigen::Vector2d(noise.up_m_per_sqrt_m, noise.tilt_rad_per_sqrt_m);
}

/// In the order of `SystematicErrors`, then what the detector's ranges have in common.
Eigen::VectorXd systematicStddev(const OdometryConfig& config) {
  Eigen::VectorXd stddev(5 + kRangeErrors);
  stddev << config.scale_stddev, config.scale_stddev, config.bend_stddev_rad_per_m, config.direction_stddev_rad,
      config.lever_stddev_m, config.range_scale_stddev, config.range_offset_stddev_m;
  return stddev;
}

ErrorInformation withDesign(StepInformation steps, int parts) {
  ErrorInformation result{std::move(steps.matrix),      std::move(steps.vector),   {},
                          std::move(steps.effect),      std::move(steps.coupling), std::move(steps.range_matrix),
                          std::move(steps.range_vector)};
  result.design = Eigen::MatrixXd::Zero(result.vector.size(), parts);
  return result;
}

ErrorInformation planarErrors(StepInformation steps) {
  const std::vector<Motion> motion = std::move(steps.motion);
  ErrorInformation result = withDesign(std::move(steps), kPlanarParts);
  for (Eigen::Index k = 0; 3 * k < result.vector.size(); ++k) {
    const Motion& step = motion[static_cast<std::size_t>(k)];
    result.design(3 * k, kAlong) = result.design(3 * k + 1, kAcross) = step.way_m;
    result.design(3 * k + 2, kHeadingByWay) = step.way_m;
    result.design(3 * k + 2, kHeadingByTurn) = step.turn_rad;
  }
  return result;
}

ErrorInformation verticalErrors(StepInformation steps) {
  const std::vector<Motion> motion = std::move(steps.motion);
  ErrorInformation result = withDesign(std::move(steps), kVerticalParts);
  for (Eigen::Index k = 0; 3 * k < result.vector.size(); ++k) {
    const double way_m = motion[static_cast<std::size_t>(k)].way_m;
    result.design(3 * k, kUp) = way_m;
    result.design(3 * k + 1, kTilt) = result.design(3 * k + 2, kTilt) = way_m;
  }
  return result;
}

/// What of an estimate is more than its own uncertainty (James, Stein, Estimation with quadratic loss, 1961, positive
/// part): the prior is wide enough for bad wheels, and most odometry is far better than that.
CoefficientEstimate beyondUncertainty(const CoefficientEstimate& estimate) {
  const double mean_sq = estimate.mean * estimate.mean;
  const double variance = estimate.stddev * estimate.stddev;
  return {mean_sq > variance ? estimate.mean * (1.0 - variance / mean_sq) : 0.0, estimate.stddev};
}

}  // namespace

void describe(OdometryConfig& config, Fields& fields) {
  fields.add("learn", config.learn,
             "Whether the odometry's errors are found out while driving; false: they are as given here.");
  describe(config.noise, fields);
  fields.add("prior_factor", config.prior_factor, "", {1.1, 100.0},
             "The errors given here are known within this factor before anything is learned.");
  fields.add("scale_stddev", config.scale_stddev, "", {1e-6, 0.5},
             "Deviation of the scales of translation and of turning before anything is learned,");
  fields.add("bend_stddev", config.bend_stddev_rad_per_m, "rad/m", {1e-9, 1.0},
             "of the bend that a straight way has by odometry,");
  fields.add("direction_stddev", config.direction_stddev_rad, "rad", {1e-9, 1.0},
             "of the angle between the base's x axis and the way,");
  fields.add("lever_stddev", config.lever_stddev_m, "m", {1e-9, 10.0},
             "and of the distance from the base to the axle that it turns about.");
  fields.add(
      "range_scale_stddev", config.range_scale_stddev, "", {1e-9, 0.5},
      "Deviation of a scale that all ranges of the detector may be wrong by: it looks like one of the odometry.");
  fields.add("range_offset_stddev", config.range_offset_stddev_m, "m", {1e-9, 10.0},
             "The same of what is added to all of them.");
}

OdometryLearning::OdometryLearning(const OdometryConfig& config)
    : config_(config),
      planar_(planarStddev(config.noise), std::log(config.prior_factor), systematicStddev(config)),
      vertical_(verticalStddev(config.noise), std::log(config.prior_factor), Eigen::VectorXd()) {
  model_.noise = config.noise;
  if (config.learn) readOff();
}

void OdometryLearning::add(const OdometryStretch& stretch) {
  if (!config_.learn || stretch.motion.empty()) return;
  planar_.add(planarErrors(planarInformation(stretch, model_)));
  vertical_.add(verticalErrors(verticalInformation(stretch, model_)));
  readOff();
}

void OdometryLearning::readOff() {
  const Eigen::VectorXd planar = planar_.stddev();
  const Eigen::VectorXd vertical = vertical_.stddev();
  model_.noise = {planar[kAlong],        planar[kAcross],        vertical[kUp],
                  planar[kHeadingByWay], planar[kHeadingByTurn], vertical[kTilt]};
  const Eigen::VectorXd& mean = planar_.effect();
  const Eigen::VectorXd stddev = planar_.effectCov().diagonal().cwiseSqrt();
  SystematicErrors& errors = model_.systematic;
  CoefficientEstimate* const all[] = {&errors.scale_translation, &errors.scale_turn, &errors.heading_rad_per_m,
                                      &errors.direction_m_per_m, &errors.lever_m_per_rad};
  for (Eigen::Index i = 0; i < mean.size() - kRangeErrors; ++i) *all[i] = beyondUncertainty({mean[i], stddev[i]});
}

}  // namespace semantic_mht_slam
