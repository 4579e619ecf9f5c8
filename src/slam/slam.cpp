#include "semantic_mht_slam/slam/slam.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "semantic_mht_slam/common/stopwatch.h"
#include "semantic_mht_slam/map/landmark_precision.h"
#include "semantic_mht_slam/mapping/landmark_sizes.h"
#include "semantic_mht_slam/slam/seen_again.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"
#include "semantic_mht_slam/slam/surroundings.h"

#include "newest_pose.h"
#include "recent_submaps.h"

namespace semantic_mht_slam {

namespace {

/// Driven between two sessions, for whoever takes what was driven lately for one pass.
constexpr double kBetweenSessions_m = 1000.0;

/// Of the reach. Followed without a fix before the place counts as one that changed, and is mapped again; and how near
/// the vehicle was if it was at a place.
constexpr double kFollowed = 1.0 / 3.0;
constexpr double kSamePlace = 1.0 / 6.0;

/// A localizer that begins where the odometry is by its present correction.
Localizer localizerHere(const Pose& T_map_odom, const SlamConfig& fitted) {
  Localizer localizer(fitted.localization);
  localizer.expectAt(T_map_odom, 0.0);
  return localizer;
}

/// Begins a submap at a frame, which is expected at `T_map_base`.
void beginSubmap(const Frame& frame, const Pose& T_map_base, const SlamConfig& fitted, SlamParts& parts) {
  const double tied_at_m = std::max(parts.tied_at_m, parts.map.closedAt_m());
  const Motion ahead = parts.map.keyframes().empty()
                           ? Motion{}
                           : motionOf(parts.map.keyframes().back().T_odom_base.inverse() * frame.T_odom_base);
  parts.prediction = parts.closer->predict(parts.map, T_map_base, tied_at_m, ahead);
  parts.submap_driven = parts.driven;
  EarlierMap earlier;
  if (fitted.back_end.close_loops) {
    earlier = earlierMapAround(parts.prediction.prior, parts.map, parts.graph, recentSubmaps(fitted),
                               fitted.mapper.alignment.radius_m);
  }
  parts.mapper->begin(frame.T_odom_base, std::move(earlier));
}

}  // namespace

SlamParts makeParts(const SlamConfig& config, const ClassTable& classes) {
  SlamParts parts{FrameAssembler(config.input),
                  Rng(config.seed),
                  {},
                  Map(config.mapper.detection.keep_prob),
                  MapGraph(config.back_end, classes),
                  {},
                  {},
                  {},
                  {},
                  {}};
  parts.odometry = OdometryLearning(config.mapper.odometry).model();
  parts.fixes = GnssFixes(config.gnss);
  fitParts(config, classes, parts);
  return parts;
}

Slam::Slam(const SlamConfig& config, const ClassTable& classes)
    : config_(config), classes_(classes), fitted_(config), parts_(makeParts(config, classes)) {}

bool Slam::addOdometry(const StampedPose& T_odom_base) {
  return isReached(T_odom_base) && take(T_odom_base);
}

/// Whether a sample follows those before it, or the one that waits, with which it then begins a session.
bool Slam::isReached(const StampedPose& T_odom_base) {
  const std::optional<StampedPose> last = parts_.sessions.latestOdometry();
  if (!last || T_odom_base.stamp <= last->stamp || !isUsable(T_odom_base)) return true;
  const bool goes_on = parts_.continuity.goesOn(T_odom_base);
  const std::optional<StampedPose> before = std::exchange(parts_.unconfirmed, std::nullopt);
  const bool is_confirmed = !goes_on && before && mayFollow(*before, T_odom_base);
  if (is_confirmed) {
    beginSession(before->stamp);
    take(*before);
    return true;
  }
  if (before) parts_.assembler.countOutlier();
  if (!goes_on) parts_.unconfirmed = T_odom_base;
  return goes_on;
}

/// A sample that comes to be used, or is counted as dropped.
bool Slam::take(const StampedPose& T_odom_base) {
  const std::optional<StampedPose> last = parts_.sessions.latestOdometry();
  if (!parts_.assembler.addOdometry(T_odom_base)) return false;
  parts_.continuity.add(T_odom_base);
  reckon(T_odom_base, parts_);
  const bool is_standing =
      last && parts_.standing.holds(last->T_world_base) && parts_.standing.holds(T_odom_base.T_world_base);
  parts_.sessions.add(T_odom_base, is_standing);
  processReadyFrames();
  return true;
}

void Slam::addDetections(Stamp stamp, Detections detections) {
  parts_.assembler.addDetections(stamp, std::move(detections));
  processReadyFrames();
}

void Slam::processReadyFrames() {
  while (auto frame = parts_.assembler.next()) {
    if (parts_.mapper && parts_.latest_frame) {
      parts_.driven = parts_.driven + motionOf(parts_.latest_frame->T_odom_base.inverse() * frame->T_odom_base);
    }
    if (parts_.mapper && parts_.standing.add(frame->T_odom_base)) {
      parts_.assembler.countStanding();
    } else if (parts_.mapper && (parts_.is_fitted || localizerOf(parts_.mode) != nullptr)) {
      process(*frame);
    } else if (parts_.mapper) {
      parts_.waiting.push_back(*frame);
      if (parts_.detector_range.add(frame->detections)) fitToDetector();
    }
    parts_.latest_frame = std::move(frame);
  }
}

void Slam::process(const Frame& frame) {
  if (localizerOf(parts_.mode) != nullptr) follow(frame);
  if (localizerOf(parts_.mode) != nullptr) return;
  if (parts_.mapper->isFullAt(frame.T_odom_base)) {
    endSubmap();
    const double reach_m = fitted_.mapper.alignment.radius_m;
    if (isPlaceKnown(parts_.map, fitted_.localization.known_passes, kSamePlace * reach_m)) {
      enter(Following{localizerHere(T_map_odom(), fitted_)});
      return follow(frame);
    }
  }
  if (!parts_.mapper->isOpen()) beginSubmap(frame, T_map_odom() * frame.T_odom_base, fitted_, parts_);
  const Stopwatch watch;
  parts_.mapper->add(frame, parts_.rng);
  parts_.mapping_s += watch.elapsed_s();
}

/// Finds the frame in the map, and goes on to another mode if that says so.
void Slam::follow(const Frame& frame) {
  Localizer& localizer = *localizerOf(parts_.mode);
  Frame calibrated = frame;
  calibrated.detections = parts_.mapper->calibrated(frame.detections);
  const double reach_m = fitted_.mapper.alignment.radius_m;
  const bool is_found = localizer.add(calibrated, parts_.map, *parts_.closer);
  if (is_found) takeFix(localizer, parts_);
  const auto* localizing = std::get_if<Localizing>(&parts_.mode);
  if (localizing != nullptr && !localizing->until_found) return;
  if (is_found) {
    const std::size_t passes = fitted_.localization.known_passes;
    const Eigen::Vector3d& position_m = localizer.fix().T_map_base.translation_m;
    const bool is_known = passes > 0 && passesAt(parts_.map, position_m, kSamePlace * reach_m) >= passes;
    is_known ? enter(Following{localizer}) : enter(Mapping{});
  } else if (localizing == nullptr && localizer.sinceFix_m() > kFollowed * reach_m) {
    enter(Mapping{});
  }
}

bool Slam::addFix(const GnssFix& fix) {
  const auto* localizing = std::get_if<Localizing>(&parts_.mode);
  if (localizing != nullptr && !localizing->until_found) return false;
  parts_.fixes.add(fix);
  return true;
}

void Slam::endSubmap() {
  if (!parts_.is_fitted && !parts_.waiting.empty()) fitToDetector();
  if (!parts_.mapper || !parts_.mapper->isOpen()) return;
  const Stopwatch watch;
  FinishedSubmap finished = parts_.mapper->finish(explained_);
  if (explained_.most > 0) unsure_.push_back(std::move(finished.unsure));
  noteSizes(finished.frames, finished.submap);
  for (MixtureLandmark& landmark : finished.submap.landmarks) landmark = withSevenDigits(std::move(landmark));
  parts_.mapping_s += watch.elapsed_s();
  Map& map = parts_.map;
  const OdometryModel& odometry = parts_.odometry = parts_.mapper->odometryModel();
  parts_.closer->setOdometry(odometry);
  CutSubmap cut = cutIntoKeyframes(finished.submap, finished.frames, parts_.submap_driven,
                                   fitted_.mapper.detection.keep_prob, odometry, fitted_.back_end.keyframe);
  const IdRange<KeyframeId> keyframes =
      map.add(std::make_shared<const Submap>(std::move(finished.submap)), std::move(cut.keyframes));
  parts_.graph.add(map, keyframes, cut.sightings, odometry);
  parts_.graph.add(parts_.fixes.take(map, parts_.sessions, false));
  if (keyframes.front() == KeyframeId(0)) noteStart(parts_);
  parts_.graph.settle(map);
  parts_.closer->add(map);
  const ClosureQuery query{keyframes, std::move(finished.alignment), std::exchange(parts_.prediction, {}),
                           parts_.tied_at_m};
  for (const ClosureSource source : parts_.closer->sources()) {
    bool is_any_verified = false;
    for (LoopClosureRecord& closure : parts_.closer->find(source, map, query)) {
      is_any_verified = is_any_verified || closure.is_verified;
      map.add(std::move(closure));
    }
    if (is_any_verified) parts_.graph.settle(map);
  }
  tieToNewestKeyframe(parts_);
  const ClosureId tie = newestTie(map);
  if (tie.isNone()) return;
  const auto same = landmarksSeenAgain(map, parts_.graph, classes_, map.closures()[tie], recentSubmaps(fitted_),
                                       fitted_.back_end.revisit.pair_distance_m);
  map.addPairs(tie, same);  // the graph joins them with its next solution
}

void Slam::finish() {
  endSubmap();
  if (parts_.map.keyframes().empty()) return;
  parts_.graph.add(parts_.fixes.take(parts_.map, parts_.sessions, true));
  parts_.graph.settle(parts_.map, true);
  tieToNewestKeyframe(parts_);
}

/// Every change of mode.
void Slam::enter(Mode mode) {
  endSubmap();
  const Localizer* before = localizerOf(parts_.mode);
  if (before != nullptr && std::holds_alternative<Mapping>(mode)) {
    parts_.driven.way_m += kBetweenSessions_m;
    parts_.tied_at_m = parts_.driven.way_m;
    parts_.graph.goOnAt(*before->T_map_odom());
    parts_.mapper->forgetSurroundings();
  }
  parts_.mode = std::move(mode);
}

void Slam::localize() {
  if (!parts_.mapper) throw std::logic_error("Slam: this method makes no map to localize in");
  endSubmap();
  if (parts_.map.submaps().empty()) throw std::logic_error("Slam: there is no map to localize in");
  const Localizer* localizer = localizerOf(parts_.mode);
  enter(Localizing{localizer != nullptr ? *localizer : localizerHere(T_map_odom(), fitted_), false});
}

void Slam::resumeMapping() {
  const Localizer* localizer = localizerOf(parts_.mode);
  if (localizer == nullptr) return;
  localizer->isLocated() ? enter(Mapping{}) : enter(Localizing{*localizer, true});
}

void Slam::beginSession(Stamp begin) {
  endSubmap();
  const auto* localizing = std::get_if<Localizing>(&parts_.mode);
  const bool is_mapping_wanted = localizing == nullptr || localizing->until_found;
  parts_.graph.add(parts_.fixes.take(parts_.map, parts_.sessions, true));
  parts_.fixes.beginSession(parts_.map.keyframes().nextId());
  parts_.assembler.beginSession(begin);
  parts_.continuity.clear();
  parts_.unconfirmed.reset();
  parts_.latest_frame.reset();
  parts_.latest.reset();
  parts_.sessions.begin(parts_.map.keyframes().nextId());
  if (parts_.map.submaps().empty()) return;
  enter(Localizing{Localizer(fitted_.localization), is_mapping_wanted});
}

bool Slam::expectAt(const Pose& T_map_base, double stddev_m) {
  Localizer* localizer = localizerOf(parts_.mode);
  const std::optional<StampedPose> odometry = parts_.sessions.latestOdometry();
  if (localizer == nullptr || !odometry) return false;
  localizer->expectAt(T_map_base * odometry->T_world_base.inverse(), stddev_m);
  expectPose(T_map_base, stddev_m, fitted_.back_end.revisit.base_stddev_rad, parts_);
  return true;
}

Pose Slam::T_map_odom() const {
  const Localizer* localizer = localizerOf(parts_.mode);
  if (localizer != nullptr) return localizer->T_map_odom().value_or(Pose::identity());
  return parts_.graph.T_map_odom(parts_.map);
}

TrajectoryRecord trajectoryRecordOf(const Slam& slam) {
  return slam.parts().sessions.record(slam.map());
}

std::vector<StampedPose> trajectoryOf(const Slam& slam) {
  return trajectoryOf(trajectoryRecordOf(slam));
}

const std::vector<MapHypothesis>& hypothesesOf(const Slam& slam) {
  static const std::vector<MapHypothesis> kNone;
  return slam.parts().mapper ? slam.parts().mapper->hypotheses() : kNone;
}

}  // namespace semantic_mht_slam
