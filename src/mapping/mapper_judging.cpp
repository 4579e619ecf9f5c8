#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "semantic_mht_slam/mapping/association_posterior.h"
#include "semantic_mht_slam/mapping/mapper.h"

// What a finished submap says of its detections and landmarks that no frame could: what moved, what shows nothing.
namespace semantic_mht_slam {
namespace {

constexpr double kCentroidInAPass = 0.5;  // of what a centroid moves between passes, as other sides are seen
constexpr double kProbSteps = 1000.0;     // thousandths, as files keep them

double inSteps(double prob) {
  return std::round(kProbSteps * prob) / kProbSteps;
}

}  // namespace

/// Takes the detections out that the detector says move.
void Mapper::dropMoving(Frame& frame) {
  Detections& detections = frame.detections;
  const auto first =
      std::stable_partition(detections.begin(), detections.end(), [](const Detection& d) { return !d.is_moving; });
  moving_counts_.flagged += static_cast<std::size_t>(detections.end() - first);
  for (auto moving = first; moving != detections.end(); ++moving) {
    moving_.push_back({frame.index, moving->row, kNoLandmark, 1.0});
  }
  detections.erase(first, detections.end());
}

/// Follows what may move, measured in the base frame.
void Mapper::trackMovable(const Frame& frame, const std::vector<Measurement>& measurements) {
  std::vector<MovableSighting> sightings;
  const Eigen::Matrix3d R = frame.T_odom_base.rotation.toRotationMatrix();
  const auto isTracked = [this](const Measurement& m) {
    return config_.moving.find && !classes_[m.class_index].is_static;
  };
  for (const Measurement& measurement : measurements) {
    if (!isTracked(measurement)) continue;
    Eigen::Matrix3d cov_m2 = R * measurement.cov_m2 * R.transpose();
    const double centroid_m = kCentroidInAPass * classes_[measurement.class_index].transition_stddev_m;
    cov_m2.diagonal().array() += centroid_m * centroid_m;
    sightings.push_back({measurement.class_index, (frame.T_odom_base * measurement.position_m).head<2>(),
                         cov_m2.topLeftCorner<2, 2>(), measurement.wander_variance_per_m});
  }
  const std::vector<MovingObjects::TrackId> tracks = movers_.add(frame.stamp, driven_m_, sightings);
  auto track = tracks.begin();
  track_of_detection_.emplace_back();
  for (const Measurement& measurement : measurements) {
    track_of_detection_.back().push_back(isTracked(measurement) ? std::optional(*track++) : std::nullopt);
  }
}

double Mapper::movingProb(std::size_t frame, std::size_t detection) const {
  const std::optional<MovingObjects::TrackId>& track = track_of_detection_[frame][detection];
  return track ? movers_.movingProb(*track) : 0.0;
}

/// Landmarks whose detections move are no landmarks.
void Mapper::judgeMotion(const std::vector<FusedAssociations>& associations, std::vector<MixtureLandmark>& landmarks) {
  for (std::size_t k = 0; k < associations.size(); ++k) {
    const std::vector<LandmarkId>& ids = associations[k].landmark_of_measurement;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] == kNoLandmark) continue;
      LandmarkSpan& span =
          spans_.try_emplace(ids[i], LandmarkSpan{id_, frames_[k].stamp, frames_[k].stamp}).first->second;
      span.submap = id_;
      span.last = frames_[k].stamp;
      ++span.sightings;
      span.moving += movingProb(k, i);
    }
  }
  for (MixtureLandmark& landmark : landmarks) {
    const auto found = spans_.find(landmark.id);
    if (found == spans_.end()) continue;
    const LandmarkSpan& span = found->second;
    landmark.existence_prob *= 1.0 - span.moving / span.sightings;
    landmark.seen_standing_s = secondsFromStamp(span.last - span.first);
  }
}

/// Spans of landmarks that the mapper does not carry on.
void Mapper::forgetSpans() {
  for (auto span = spans_.begin(); span != spans_.end();) {
    span = propagation_.carries(span->first) ? std::next(span) : spans_.erase(span);
  }
}

/// The probability of each association; what moves belongs to no landmark.
void Mapper::judgeAssociations(const std::vector<FusedAssociations>& fused, const std::vector<Frame>& frames,
                               const std::vector<MixtureLandmark>& landmarks,
                               std::vector<DetectionAssociation>& associations, UnsureSelection& unsure) {
  noise_of_class_ = {};
  std::vector<double> driven_m;
  std::map<LandmarkId, double> seen_at_m;
  auto next = associations.begin();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double step_m = k == 0 ? 0.0 : motionOf(frames[k - 1].T_odom_base.inverse() * frames[k].T_odom_base).way_m;
    driven_m.push_back(k == 0 ? 0.0 : driven_m.back() + step_m);
    for (std::size_t i = 0; i < frames[k].detections.size(); ++i) seen_at_m[(next++)->landmark] = driven_m.back();
  }
  std::vector<std::pair<MixtureLandmark, double>> seen;
  std::map<LandmarkId, const MixtureLandmark*> by_id;
  for (const MixtureLandmark& landmark : landmarks) {
    const auto found = seen_at_m.find(landmark.id);
    if (found == seen_at_m.end()) continue;
    seen.emplace_back(landmark, found->second);
    by_id[landmark.id] = &landmark;
  }
  AssociationPosterior posterior(config_, tree_.model(), tree_.detectionRate(), std::move(seen));
  ClutterModel learned = tree_.clutter();  // what is judged is judged by what was known before
  learned.addFrames(frames.size());
  std::set<LandmarkId> begun;
  next = associations.begin();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Pose T = corrected(T_submap_base(frames[k]), fused[k].offset);
    std::vector<Measurement> measurements;
    std::vector<LandmarkId> assigned;
    measurements.reserve(frames[k].detections.size());
    assigned.reserve(frames[k].detections.size());
    for (std::size_t i = 0; i < frames[k].detections.size(); ++i) {
      measurements.push_back(inSubmap(makeMeasurement(frames[k].detections[i]), T, &fused[k].offset));
      assigned.push_back(next[static_cast<std::ptrdiff_t>(i)].landmark);
    }
    const std::vector<JudgedAssociation> judged = posterior.judge(measurements, driven_m[k], assigned);
    for (std::size_t i = 0; i < measurements.size(); ++i, ++next) {
      const double standing_prob = 1.0 - movingProb(k, i);
      const auto landmark = by_id.find(next->landmark);
      const bool is_first =
          landmark != by_id.end() && landmark->second->first_submap == id_ && begun.insert(next->landmark).second;
      const bool is_seen_again = landmark != by_id.end() && landmark->second->observations > 1;
      const double exists = is_seen_again ? landmark->second->existence_prob : 0.0;
      const double clutter = next->landmark == kNoLandmark ? judged[i].nothing_prob : 1.0 - exists;
      learned.add(measurements[i].class_index, measurements[i].ray_m, standing_prob * clutter, is_first ? exists : 0.0);
      if (standing_prob < 0.5) {
        ++moving_counts_.found;
        next->landmark = kNoLandmark;
      }
      next->probability = inSteps(next->landmark == kNoLandmark ? 1.0 - standing_prob * (1.0 - judged[i].nothing_prob)
                                                                : judged[i].own_prob);
      unsure.note(next->probability, [&] {
        return UnsureDetection{next->frame,
                               frames[k].stamp,
                               next->row,
                               measurements[i].class_index,
                               measurements[i].position_m,
                               next->landmark,
                               next->probability,
                               1.0 - standing_prob,
                               tree_.model().logClutterDensity(measurements[i]),
                               posterior.alternatives(i, measurements[i], driven_m[k])};
      });
    }
  }
  tree_.clutter() = std::move(learned);
}

}  // namespace semantic_mht_slam
