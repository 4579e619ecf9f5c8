#include "semantic_mht_slam/mapping/moving_objects.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "semantic_mht_slam/common/log_math.h"

namespace semantic_mht_slam {
namespace {

constexpr double kAccelerationPerSpeed = 0.3;  // 1/s: deviations of acceleration and of speed
constexpr double kOutlierProb = 0.1;
constexpr double kOutlierFactor = 3.0;
constexpr double kTrackGateMahalanobisSq = 16.0;
constexpr int kMostMissed = 10;       // frames that a track survives without a sighting
constexpr int kTellingSightings = 5;  // of tracks that say how many move
constexpr double kRateSamples = 4.0;  // that the prior counts for
constexpr double kMostTrackLogOdds = 20.0;
constexpr double kMostLogOddsOfNext = 3.0;  // that an object goes on as it did: one that stood may drive off
constexpr double kAnywhere = 2.0;           // gates that what has no track may be in

struct Planar {
  double mahalanobis_sq;
  double log_density;
};

Planar evaluate(const Eigen::Vector2d& d, const Eigen::Matrix2d& cov_m2) {
  const double mahalanobis_sq = d.dot(cov_m2.inverse() * d);
  return {mahalanobis_sq, -0.5 * (mahalanobis_sq + std::log(cov_m2.determinant())) - std::log(2.0 * M_PI)};
}

/// Of a sighting whose centroid may be far off.
Planar evaluateMixture(const Eigen::Vector2d& d, const Eigen::Matrix2d& state_cov_m2,
                       const Eigen::Matrix2d& noise_cov_m2) {
  const Planar narrow = evaluate(d, state_cov_m2 + noise_cov_m2);
  const Planar wide = evaluate(d, state_cov_m2 + kOutlierFactor * kOutlierFactor * noise_cov_m2);
  return {wide.mahalanobis_sq,
          logAdd(std::log1p(-kOutlierProb) + narrow.log_density, std::log(kOutlierProb) + wide.log_density)};
}

/// Kalman update by a position. An unlikely one, whose centroid is probably far off, counts for less.
template <int kSize>
void updateBy(const Eigen::Vector2d& position_m, const Eigen::Matrix2d& noise_cov_m2,
              Eigen::Matrix<double, kSize, 1>& state, Eigen::Matrix<double, kSize, kSize>& cov) {
  const Eigen::Vector2d d = position_m - state.template head<2>();
  const Eigen::Matrix2d position_cov_m2 = cov.template topLeftCorner<2, 2>();
  const double narrow = evaluate(d, position_cov_m2 + noise_cov_m2).log_density + std::log1p(-kOutlierProb);
  const Eigen::Matrix2d wide_m2 = kOutlierFactor * kOutlierFactor * noise_cov_m2;
  const double wide = evaluate(d, position_cov_m2 + wide_m2).log_density + std::log(kOutlierProb);
  const Eigen::Matrix2d innovation_cov = position_cov_m2 + (wide > narrow ? wide_m2 : noise_cov_m2);
  const Eigen::Matrix<double, kSize, 2> gain = cov.template leftCols<2>() * innovation_cov.inverse();
  state += gain * d;
  const Eigen::Matrix<double, kSize, kSize> updated = cov - gain * cov.template topRows<2>();
  cov = 0.5 * (updated + updated.transpose());
}

}  // namespace

void describe(MovingConfig& config, Fields& fields) {
  fields.add("find", config.find,
             "Whether objects of movable classes that move are found out and kept out of the map (the paper: false).");
  fields.add("prior_prob", config.prior_prob, "", {0.001, 0.999},
             "Share of a movable class's objects that move, before it is known.");
  fields.add("speed_stddev", config.speed_stddev_mps, "m/s", {0.001, 1000.0}, "Deviation of their velocities.");
}

MovingObjects::MovingObjects(const MovingConfig& config, int class_count, double max_gate_m)
    : config_(config), max_gate_m_(max_gate_m), rate_of_class_(static_cast<std::size_t>(class_count)) {}

double MovingObjects::priorProb(ClassIndex class_index) const {
  const Rate& rate = rate_of_class_[static_cast<std::size_t>(class_index)];
  return (rate.moving + kRateSamples * config_.prior_prob) / (rate.all + kRateSamples);
}

MovingObjects::Track MovingObjects::begun(Stamp stamp, double driven_m, const MovableSighting& sighting) {
  Track track;
  track.id = next_id_++;
  track.class_index = sighting.class_index;
  track.stamp = stamp;
  track.driven_m = driven_m;
  track.wander_variance_per_m = sighting.wander_variance_per_m;
  track.place_m = track.motion.head<2>() = sighting.position_m;
  track.place_cov_m2 = sighting.cov_m2;
  const double speed_variance = config_.speed_stddev_mps * config_.speed_stddev_mps;
  track.motion_cov = Eigen::Vector4d(0.0, 0.0, speed_variance, speed_variance).asDiagonal();
  track.motion_cov.topLeftCorner<2, 2>() = sighting.cov_m2;
  track.log_odds = logit(priorProb(sighting.class_index));
  return track;
}

MovingObjects::Track MovingObjects::predicted(const Track& track, Stamp stamp, double driven_m) const {
  Track result = track;
  const double seconds = secondsFromStamp(stamp - track.stamp);
  const double wander_m2 = track.wander_variance_per_m * (driven_m - track.driven_m);
  result.stamp = stamp;
  result.driven_m = driven_m;
  result.place_cov_m2.diagonal().array() += wander_m2;
  Eigen::Matrix4d step = Eigen::Matrix4d::Identity();
  step.topRightCorner<2, 2>() = seconds * Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 4, 2> push;
  push << 0.5 * seconds * seconds * Eigen::Matrix2d::Identity(), seconds * Eigen::Matrix2d::Identity();
  const double acceleration = kAccelerationPerSpeed * config_.speed_stddev_mps;
  result.motion = step * track.motion;
  result.motion_cov =
      step * track.motion_cov * step.transpose() + acceleration * acceleration * push * push.transpose();
  result.motion_cov.diagonal().head<2>().array() += wander_m2;
  return result;
}

std::optional<MovingObjects::Likelihoods> MovingObjects::compare(const Track& predicted,
                                                                 const MovableSighting& sighting) const {
  if (predicted.class_index != sighting.class_index) return std::nullopt;
  const Eigen::Vector2d of_standing = sighting.position_m - predicted.place_m;
  const Eigen::Vector2d of_moving = sighting.position_m - predicted.motion.head<2>();
  if (std::min(of_standing.norm(), of_moving.norm()) > max_gate_m_) return std::nullopt;
  const Planar standing = evaluateMixture(of_standing, predicted.place_cov_m2, sighting.cov_m2);
  const Planar moving = evaluateMixture(of_moving, predicted.motion_cov.topLeftCorner<2, 2>(), sighting.cov_m2);
  if (std::min(standing.mahalanobis_sq, moving.mahalanobis_sq) > kTrackGateMahalanobisSq) return std::nullopt;
  return Likelihoods{standing.log_density, moving.log_density};
}

void MovingObjects::update(const Likelihoods& likelihoods, const MovableSighting& sighting, Track& predicted) {
  updateBy<2>(sighting.position_m, sighting.cov_m2, predicted.place_m, predicted.place_cov_m2);
  updateBy<4>(sighting.position_m, sighting.cov_m2, predicted.motion, predicted.motion_cov);
  predicted.log_odds =
      std::clamp(predicted.log_odds + likelihoods.moving - likelihoods.standing, -kMostTrackLogOdds, kMostTrackLogOdds);
  predicted.missed = 0;
  ++predicted.sightings;
}

double MovingObjects::logDensity(const Likelihoods& likelihoods, double log_odds) {
  const double odds = std::exp(std::clamp(log_odds, -kMostLogOddsOfNext, kMostLogOddsOfNext));
  return logAdd(likelihoods.standing, std::log(odds) + likelihoods.moving) - std::log1p(odds);
}

std::vector<MovingObjects::TrackId> MovingObjects::add(Stamp stamp, double driven_m,
                                                       const std::vector<MovableSighting>& sightings) {
  const auto known = static_cast<int>(tracks_.size());
  const double log_anywhere = -std::log(kAnywhere * M_PI * max_gate_m_ * max_gate_m_);
  std::vector<Track> expected;
  for (const Track& track : tracks_) expected.push_back(predicted(track, stamp, driven_m));
  std::map<std::pair<int, int>, Likelihoods> candidates;
  SparseCostMatrix costs;
  costs.clear(known + static_cast<int>(sightings.size()));
  for (int i = 0; i < static_cast<int>(sightings.size()); ++i) {
    costs.addRow();
    for (int j = 0; j < known; ++j) {
      const Track& track = expected[static_cast<std::size_t>(j)];
      const auto likelihoods = compare(track, sightings[static_cast<std::size_t>(i)]);
      if (!likelihoods) continue;
      costs.add(j, -logDensity(*likelihoods, track.log_odds));
      candidates.emplace(std::make_pair(i, j), *likelihoods);
    }
    costs.add(known + i, -log_anywhere);
  }
  const Assignment assignment = solver_.solve(costs).value();  // each row has a column of its own
  for (Track& track : tracks_) ++track.missed;
  std::vector<TrackId> result;
  for (int i = 0; i < static_cast<int>(sightings.size()); ++i) {
    const MovableSighting& sighting = sightings[static_cast<std::size_t>(i)];
    const int column = assignment.column_for_row[static_cast<std::size_t>(i)];
    if (column < known) {
      Track& track = tracks_[static_cast<std::size_t>(column)] = expected[static_cast<std::size_t>(column)];
      update(candidates.at({i, column}), sighting, track);
      result.push_back(track.id);
    } else {
      tracks_.push_back(begun(stamp, driven_m, sighting));
      result.push_back(tracks_.back().id);
    }
  }
  endMissed();
  return result;
}

void MovingObjects::endMissed() {
  const auto isOver = [](const Track& track) { return track.missed > kMostMissed; };
  for (const Track& track : tracks_) {
    known_prob_[track.id] = logistic(track.log_odds);
    if (isOver(track)) end(track);
  }
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), isOver), tracks_.end());
}

void MovingObjects::end(const Track& track) {
  if (track.sightings < kTellingSightings) return;
  Rate& rate = rate_of_class_[static_cast<std::size_t>(track.class_index)];
  rate.moving += logistic(track.log_odds);
  rate.all += 1.0;
}

void MovingObjects::forgetEnded() {
  known_prob_.clear();
  for (const Track& track : tracks_) known_prob_[track.id] = logistic(track.log_odds);
}

void MovingObjects::clear() {
  for (const Track& track : tracks_) end(track);
  tracks_.clear();
}

}  // namespace semantic_mht_slam
