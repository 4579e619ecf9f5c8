#include "alignment_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kLogTwoPi = 1.8378770664093453;
constexpr double kImpossible = -std::numeric_limits<double>::infinity();

void check(const std::vector<AlignmentPoint>& points, const char* kind, const ClassTable& classes) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const char* problem = nullptr;
    if (!points[i].position_m.allFinite())
      problem = " is not finite";
    else if (!isCovariance(points[i].cov_m2))
      problem = " has no positive definite covariance";
    else if (points[i].class_index < 0 || points[i].class_index >= classes.size())
      problem = " has an unknown class";
    if (problem == nullptr) continue;
    throw std::invalid_argument(std::string("alignJointly: ") + kind + " " + std::to_string(i) + problem);
  }
}

void check(const AlignmentPrior& prior) {
  if (!prior.T_a_b.isValid()) throw std::invalid_argument("alignJointly: the prior is no pose");
  for (const double stddev : {prior.stddev_xy_m, prior.stddev_z_m, prior.stddev_yaw_rad}) {
    if (std::isfinite(stddev) && stddev > 0.0) continue;
    throw std::invalid_argument("alignJointly: the prior has a deviation that is not positive");
  }
}

/// Brings points into one order that depends on their values alone: by class, then by x.
void sortPoints(std::vector<LevelledPoint>& points) {
  const auto rest = [](const LevelledPoint& p) {
    return std::make_tuple(p.position_m.y(), p.position_m.z(), p.cov_m2(0, 0), p.cov_m2(1, 1), p.cov_m2(2, 2),
                           p.cov_m2(0, 1), p.cov_m2(0, 2), p.cov_m2(1, 2));
  };
  std::sort(points.begin(), points.end(), [&](const LevelledPoint& a, const LevelledPoint& b) {
    if (a.class_index != b.class_index) return a.class_index < b.class_index;
    if (a.position_m.x() != b.position_m.x()) return a.position_m.x() < b.position_m.x();
    return rest(a) < rest(b);
  });
}

/// The points after p -> rotation * (p - origin).
std::vector<LevelledPoint> levelled(const std::vector<AlignmentPoint>& points, const Eigen::Matrix3d& rotation,
                                    const Eigen::Vector3d& origin_m) {
  std::vector<LevelledPoint> result;
  result.reserve(points.size());
  for (const AlignmentPoint& point : points) {
    const Eigen::Matrix3d cov_m2 = rotation * point.cov_m2 * rotation.transpose();
    result.push_back({rotation * (point.position_m - origin_m), 0.5 * (cov_m2 + cov_m2.transpose()), point.class_index,
                      static_cast<int>(result.size())});
  }
  sortPoints(result);
  return result;
}

/// log P(seen | true) of two classes. Only classes that are both static or both movable are mistaken for each other.
std::vector<std::vector<double>> logClassProbs(const ClassTable& classes, double confusion_prob) {
  std::vector<std::vector<double>> result(classes.size(), std::vector<double>(classes.size(), kImpossible));
  for (int truth = 0; truth < classes.size(); ++truth) {
    int others = -1;
    for (const ClassInfo& info : classes.all()) others += info.is_static == classes[truth].is_static;
    for (int seen = 0; seen < classes.size(); ++seen) {
      if (classes[seen].is_static != classes[truth].is_static) continue;
      const double confused_prob = others > 0 ? confusion_prob : 0.0;
      result[truth][seen] = std::log(seen == truth ? 1.0 - confused_prob : confused_prob / others);
    }
  }
  return result;
}

bool hasLandmarkAround(const AlignmentProblem& problem, const LevelledPoint& detection, double radius_m) {
  return std::any_of(problem.landmarks.begin(), problem.landmarks.end(), [&](const LevelledPoint& landmark) {
    return (landmark.position_m - detection.position_m).head<2>().squaredNorm() < radius_m * radius_m;
  });
}

/// What bounds the reach of matches with a point.
struct Spread {
  double det = std::numeric_limits<double>::infinity();  ///< of its covariance
  double largest_variance_m2 = 0.0;                      ///< horizontal
};

Spread spreadOf(const Eigen::Matrix3d& cov_m2) {
  const double mean = 0.5 * (cov_m2(0, 0) + cov_m2(1, 1));
  return {cov_m2.determinant(), mean + std::hypot(0.5 * (cov_m2(0, 0) - cov_m2(1, 1)), cov_m2(0, 1))};
}

/// What a detection at a given range adds to the covariance of the residual, apart from its own.
Eigen::Matrix3d extraCov(const ClassInfo& landmark_class, double range_m, const JointAlignmentConfig& config) {
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity() * (config.noise_floor_m * config.noise_floor_m);
  if (landmark_class.transition == Transition::kGaussian) {
    cov_m2.diagonal().array() += landmark_class.transition_stddev_m * landmark_class.transition_stddev_m;
  }
  cov_m2(2, 2) += std::pow(config.tilt_stddev_rad * range_m, 2);
  return cov_m2;
}

/// Horizontal distance beyond which a match is no better than none, whatever the heading; negative if there is no such
/// match. Bounds the density by det(A + B) >= det A + det B and the distance by the largest eigenvalues.
double reach(const Spread& detection, const Spread& landmark, double log_odds) {
  const double log_peak_odds = log_odds - 0.5 * (3.0 * kLogTwoPi + std::log(detection.det + landmark.det));
  if (log_peak_odds <= 0.0) return -1.0;
  return std::sqrt(2.0 * log_peak_odds * (detection.largest_variance_m2 + landmark.largest_variance_m2));
}

using Points = std::vector<LevelledPoint>::const_iterator;

/// The landmarks of a class, which are sorted by x, and the spread of one that would reach as far as any of them: most
/// pairs are too far apart for a match.
struct ClassLandmarks {
  Points begin;
  Points end;
  Spread farthest;

  /// The first one from `x_m` on.
  Points firstFrom(double x_m) const {
    return std::lower_bound(begin, end, x_m, [](const LevelledPoint& p, double x) { return p.position_m.x() < x; });
  }
};

/// Of every class. Spreads at range 0: the range adds to the vertical variance alone, which makes determinants larger.
std::vector<ClassLandmarks> landmarksByClass(const std::vector<LevelledPoint>& landmarks, const ClassTable& classes,
                                             const JointAlignmentConfig& config) {
  std::vector<ClassLandmarks> result;
  Points end = landmarks.begin();
  for (int c = 0; c < classes.size(); ++c) {
    ClassLandmarks known{end, end, {}};
    for (; end != landmarks.end() && end->class_index == c; ++end) {
      const Spread spread = spreadOf(end->cov_m2 + extraCov(classes[c], 0.0, config));
      known.farthest.det = std::min(known.farthest.det, spread.det);
      known.farthest.largest_variance_m2 = std::max(known.farthest.largest_variance_m2, spread.largest_variance_m2);
    }
    known.end = end;
    result.push_back(known);
  }
  return result;
}

/// Landmarks of each class per cubic metre around where the detections of that class are expected. Counted there and
/// not over the whole map, because objects stand in rows along streets and chance matches are as frequent as the rows
/// are dense.
std::vector<double> classDensities(const AlignmentProblem& problem, const std::vector<ClassLandmarks>& by_class,
                                   const JointAlignmentConfig& config) {
  const double radius_m = config.density_radius_m;
  std::vector<int> detections(by_class.size(), 0);
  std::vector<int> neighbours(by_class.size(), 0);
  for (const LevelledPoint& detection : problem.detections) {
    const auto c = static_cast<std::size_t>(detection.class_index);
    ++detections[c];
    const double x_end_m = detection.position_m.x() + radius_m;
    Points landmark = by_class[c].firstFrom(detection.position_m.x() - radius_m);
    for (; landmark != by_class[c].end && landmark->position_m.x() <= x_end_m; ++landmark) {
      const double distance_sq = (landmark->position_m - detection.position_m).head<2>().squaredNorm();
      if (distance_sq < radius_m * radius_m) ++neighbours[c];
    }
  }
  const double volume_m3 = M_PI * radius_m * radius_m * config.density_height_m;
  std::vector<double> densities;
  for (std::size_t c = 0; c < by_class.size(); ++c) {
    densities.push_back(std::max(1.0, neighbours[c] / std::max(1.0, 1.0 * detections[c])) / volume_m3);
  }
  return densities;
}

/// Largest gaps that offsets inside the window can close for a detection.
Eigen::Vector3d closable(const LevelledPoint& detection, const Eigen::Vector4d& window) {
  const double turn_m = window(3) * detection.position_m.head<2>().norm();
  return window.head<3>() + Eigen::Vector3d(turn_m, turn_m, 0.0);
}

bool isWithin(const Eigen::Vector3d& gap_m, const Eigen::Vector3d& closable_m, double reach_m) {
  return std::abs(gap_m.x()) < closable_m.x() + reach_m && std::abs(gap_m.y()) < closable_m.y() + reach_m &&
         std::abs(gap_m.z()) < closable_m.z() + reach_m;
}

/// Landmarks that a detection may be; `log_odds` is what holds for all of them.
std::vector<AlignmentCandidate> findCandidates(const AlignmentProblem& problem,
                                               const std::vector<ClassLandmarks>& by_class,
                                               const LevelledPoint& detection, const ClassTable& classes,
                                               const JointAlignmentConfig& config, double log_odds,
                                               const std::vector<std::vector<double>>& log_class_probs) {
  const double range_m = detection.position_m.head<2>().norm();
  const Eigen::Vector3d closable_m = closable(detection, problem.window);
  const Spread spread = spreadOf(detection.cov_m2);
  std::vector<AlignmentCandidate> candidates;
  for (int c = 0; c < classes.size(); ++c) {
    const double log_class_prob = log_class_probs[c][detection.class_index];
    const ClassLandmarks& known = by_class[static_cast<std::size_t>(c)];
    const double farthest_m = reach(spread, known.farthest, log_odds + log_class_prob);
    if (log_class_prob == kImpossible || farthest_m <= 0.0) continue;
    const double farthest_x_m = closable_m.x() + farthest_m;
    const double x_end_m = detection.position_m.x() + farthest_x_m;
    const Eigen::Matrix3d extra_cov_m2 = extraCov(classes[c], range_m, config);
    Points landmark = known.firstFrom(detection.position_m.x() - farthest_x_m);
    for (; landmark != known.end && landmark->position_m.x() <= x_end_m; ++landmark) {
      const Eigen::Vector3d gap_m = landmark->position_m - detection.position_m;
      if (!isWithin(gap_m, closable_m, farthest_m)) continue;
      AlignmentCandidate candidate;
      candidate.landmark = static_cast<int>(landmark - problem.landmarks.begin());
      candidate.is_same_class = c == detection.class_index;
      candidate.log_odds = log_odds + log_class_prob;
      candidate.cov_m2 = landmark->cov_m2 + extra_cov_m2;
      candidate.reach_m = reach(spread, spreadOf(candidate.cov_m2), candidate.log_odds);
      if (candidate.reach_m > 0.0 && isWithin(gap_m, closable_m, candidate.reach_m)) candidates.push_back(candidate);
    }
  }
  return candidates;
}

}  // namespace

Eigen::Matrix3d headingRotation(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

AlignmentProblem makeAlignmentProblem(const std::vector<AlignmentPoint>& detections,
                                      const std::vector<AlignmentPoint>& landmarks, const AlignmentPrior& prior,
                                      const ClassTable& classes, const JointAlignmentConfig& config) {
  check(detections, "detection", classes);
  check(landmarks, "landmark", classes);
  check(prior);
  AlignmentProblem problem;
  const Eigen::Matrix3d R_a_b = prior.T_a_b.rotation.toRotationMatrix();
  problem.prior_heading_rad = std::atan2(R_a_b(1, 0), R_a_b(0, 0));
  const Eigen::Matrix3d R_level_a = headingRotation(-problem.prior_heading_rad);
  problem.detections = levelled(detections, R_level_a * R_a_b, Eigen::Vector3d::Zero());
  problem.landmarks = levelled(landmarks, R_level_a, prior.T_a_b.translation_m);
  problem.prior_stddev << prior.stddev_xy_m, prior.stddev_xy_m, prior.stddev_z_m, prior.stddev_yaw_rad;
  problem.window = config.window_sigmas * problem.prior_stddev;
  problem.window.head<3>() = problem.window.head<3>().cwiseMin(config.max_window_m);
  problem.window(3) = std::min(problem.window(3), M_PI);

  const std::vector<ClassLandmarks> by_class = landmarksByClass(problem.landmarks, classes, config);
  const std::vector<double> densities = classDensities(problem, by_class, config);
  const std::vector<std::vector<double>> log_class_probs = logClassProbs(classes, config.confusion_prob);
  for (const LevelledPoint& detection : problem.detections) {
    const ClassInfo& info = classes[detection.class_index];
    const double match_prob = info.is_static ? config.static_match_prob : config.movable_match_prob;
    const double log_odds = std::log(match_prob / (1.0 - match_prob)) - std::log(densities[detection.class_index]);
    problem.candidates.push_back(
        findCandidates(problem, by_class, detection, classes, config, log_odds, log_class_probs));
    problem.is_static.push_back(info.is_static);
    problem.is_covered.push_back(hasLandmarkAround(problem, detection, config.density_radius_m));
  }
  return problem;
}

}  // namespace semantic_mht_slam
