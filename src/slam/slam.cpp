#include "semantic_mht_slam/slam/slam.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "semantic_mht_slam/common/stopwatch.h"
#include "semantic_mht_slam/slam/surroundings.h"

namespace semantic_mht_slam {

namespace {

const std::vector<std::pair<std::string, Method>> kMethods = {
    {"odometry", Method::kOdometry}, {"ukf", Method::kUkf}, {"mhm", Method::kMhm}, {"dpmhm", Method::kDpmhm}};

/// Driven between two sessions, for whoever takes what was driven lately for one pass.
constexpr double kBetweenSessions_m = 1000.0;

/// Followed without a fix before the place counts as one that changed, and is mapped again.
constexpr double kFollowed_m = 20.0;

constexpr double kMaxPause_s = 60.0;
constexpr double kMaxSpeed_m_s = 60.0;

/// Solutions after one that took closures back, so that what they had joined comes apart.
constexpr int kMoreSolutions = 3;

OdometryNoise odometryNoiseOf(const SubmapConfig& submap) {
  return {submap.odometry_stddev_m, submap.odometry_stddev_rad};
}

/// Submaps whose landmarks the mapper itself may carry on into the present one.
std::size_t recentSubmaps(const SlamConfig& config) {
  const SubmapConfig& submap = config.mapper.submap;
  const double recent_m = std::max(config.back_end.revisit.min_driven_m, submap.propagation_m);
  return static_cast<std::size_t>(recent_m / submap.length_m) + 2;
}

SlamParts makeParts(const SlamConfig& config, const ClassTable& classes) {
  SlamParts parts{FrameAssembler(config.input),
                  Rng(config.seed),
                  {},
                  Map(config.mapper.detection.keep_prob),
                  MapGraph(config.back_end, odometryNoiseOf(config.mapper.submap), classes),
                  {},
                  {},
                  {},
                  {},
                  {}};
  if (config.method == Method::kOdometry) return parts;
  parts.mapper.emplace(config.mapper, classes, config.registration);
  parts.closer.emplace(config.back_end, classes, config.registration);
  return parts;
}

}  // namespace

std::string nameOf(Method method) {
  for (const auto& [name, value] : kMethods) {
    if (value == method) return name;
  }
  throw std::logic_error("a method without a name");
}

SlamConfig defaultsOf(Method method) {
  SlamConfig config;
  config.method = method;
  if (method == Method::kUkf) config.mapper = defaultsOf(Estimator::kUkf);
  if (method == Method::kMhm) config.mapper = defaultsOf(Estimator::kMhm);
  return config;
}

void describe(SlamConfig& config, Fields& fields) {
  fields.add<Method>("method", config.method, kMethods,
                     "How the map is made; ukf and mhm have other defaults for some keys (docs/method.md).");
  fields.add("seed", config.seed, "", "Seed of everything random: same input and seed, same result.");
  fields.group("input", config.input);
  fields.group("registration", config.registration);
  describe(config.mapper, fields);
  describe(config.back_end, fields);
  fields.group("localization", config.localization);
}

bool goesOn(const StampedPose& last, const StampedPose& next) {
  const double pause_s = secondsFromStamp(next.stamp - last.stamp);
  const double way_m = (next.T_world_base.translation_m - last.T_world_base.translation_m).norm();
  return pause_s > 0.0 && pause_s <= kMaxPause_s && way_m <= kMaxSpeed_m_s * pause_s;
}

Slam::Slam(const SlamConfig& config, const ClassTable& classes) : config_(config), parts_(makeParts(config, classes)) {}

bool Slam::addOdometry(const StampedPose& T_odom_base) {
  if (!parts_.assembler.addOdometry(T_odom_base)) return false;
  parts_.sessions.add(T_odom_base);
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
      parts_.driven_m += (frame->T_odom_base.translation_m - parts_.latest_frame->T_odom_base.translation_m).norm();
    }
    if (parts_.mapper) process(*frame);
    parts_.latest_frame = std::move(frame);
  }
}

void Slam::process(const Frame& frame) {
  if (localizerOf(parts_.mode) != nullptr) follow(frame);
  if (localizerOf(parts_.mode) != nullptr) return;
  if (parts_.mapper->isFullAt(frame.T_odom_base)) {
    endSubmap();
    if (isPlaceKnown(parts_.map, config_.localization.known_passes)) {
      enter(Following{localizerHere()});
      return follow(frame);
    }
  }
  if (!parts_.mapper->isOpen()) beginSubmap(frame);
  const Stopwatch watch;
  parts_.mapper->add(frame, parts_.rng);
  parts_.mapping_s += watch.elapsed_s();
}

/// Finds the frame in the map, and goes on to another mode if that says so.
void Slam::follow(const Frame& frame) {
  Localizer& localizer = *localizerOf(parts_.mode);
  Frame calibrated = frame;
  calibrated.detections = parts_.mapper->calibrated(frame.detections);
  const bool is_found = localizer.add(calibrated, parts_.map, *parts_.closer);
  if (is_found) parts_.sessions.add(localizer.fix());
  const auto* localizing = std::get_if<Localizing>(&parts_.mode);
  if (localizing != nullptr && !localizing->until_found) return;
  if (is_found) {
    const std::size_t passes = config_.localization.known_passes;
    const bool is_known = passes > 0 && passesAt(parts_.map, localizer.fix().T_map_base.translation_m) >= passes;
    is_known ? enter(Following{localizer}) : enter(Mapping{});
  } else if (localizing == nullptr && localizer.sinceFix_m() > kFollowed_m) {
    enter(Mapping{});
  }
}

void Slam::beginSubmap(const Frame& frame) {
  const double drifted_m = parts_.driven_m - std::max(parts_.tied_at_m, parts_.map.closedAt_m());
  parts_.prediction = parts_.closer->predict(parts_.map, T_map_odom() * frame.T_odom_base, std::max(0.0, drifted_m));
  parts_.submap_driven_m = parts_.driven_m;
  EarlierMap earlier;
  if (config_.back_end.close_loops) {
    earlier = earlierMapAround(parts_.prediction.prior, parts_.map, parts_.graph, recentSubmaps(config_));
  }
  parts_.mapper->begin(frame.T_odom_base, std::move(earlier));
}

void Slam::endSubmap() {
  if (!parts_.mapper || !parts_.mapper->isOpen()) return;
  const Stopwatch watch;
  FinishedSubmap finished = parts_.mapper->finish();
  parts_.mapping_s += watch.elapsed_s();
  Map& map = parts_.map;
  CutSubmap cut =
      cutIntoKeyframes(finished.submap, finished.frames, parts_.submap_driven_m, config_.mapper.detection.keep_prob,
                       odometryNoiseOf(config_.mapper.submap), config_.back_end.keyframe);
  const IdRange<KeyframeId> keyframes =
      map.add(std::make_shared<const Submap>(std::move(finished.submap)), std::move(cut.keyframes));
  parts_.graph.add(map, keyframes, cut.sightings);
  optimize();
  parts_.closer->add(map);
  const ClosureQuery query{keyframes, std::move(finished.alignment), parts_.prediction, parts_.tied_at_m};
  for (const ClosureSource source : parts_.closer->sources()) {
    bool is_any_verified = false;
    for (LoopClosureRecord& closure : parts_.closer->find(source, map, query)) {
      is_any_verified = is_any_verified || closure.is_verified;
      map.add(std::move(closure));
    }
    if (is_any_verified) optimize();
  }
}

void Slam::optimize(bool is_whole) {
  Map& map = parts_.map;
  map.apply(parts_.graph.review(map));
  for (int solution = 0; solution <= kMoreSolutions; ++solution) {
    const auto changed = map.takeChanges();
    map.apply(is_whole ? parts_.graph.optimizeFully(changed) : parts_.graph.optimize(changed));
    if (map.identity().changedNames().empty()) return;
  }
}

void Slam::finish() {
  endSubmap();
  if (!parts_.map.keyframes().empty()) optimize(true);
}

/// A localizer that begins where the odometry is by its present correction.
Localizer Slam::localizerHere() const {
  Localizer localizer(config_.localization, config_.back_end.revisit);
  localizer.expectAt(T_map_odom(), 0.0);
  return localizer;
}

/// Every change of mode.
void Slam::enter(Mode mode) {
  endSubmap();
  const Localizer* before = localizerOf(parts_.mode);
  if (before != nullptr && std::holds_alternative<Mapping>(mode)) {
    parts_.driven_m += kBetweenSessions_m;
    parts_.tied_at_m = parts_.driven_m;
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
  enter(Localizing{localizer != nullptr ? *localizer : localizerHere(), false});
}

void Slam::resumeMapping() {
  const Localizer* localizer = localizerOf(parts_.mode);
  if (localizer == nullptr) return;
  localizer->isLocated() ? enter(Mapping{}) : enter(Localizing{*localizer, true});
}

void Slam::beginSession() {
  endSubmap();
  const auto* localizing = std::get_if<Localizing>(&parts_.mode);
  const bool is_mapping_wanted = localizing == nullptr || localizing->until_found;
  parts_.assembler.beginSession();
  parts_.latest_frame.reset();
  parts_.sessions.begin(parts_.map.keyframes().nextId());
  if (parts_.map.submaps().empty()) return;
  enter(Localizing{Localizer(config_.localization, config_.back_end.revisit), is_mapping_wanted});
}

bool Slam::expectAt(const Pose& T_map_base, double stddev_m) {
  Localizer* localizer = localizerOf(parts_.mode);
  const std::optional<StampedPose> odometry = parts_.sessions.latestOdometry();
  if (localizer == nullptr || !odometry) return false;
  localizer->expectAt(T_map_base * odometry->T_world_base.inverse(), stddev_m);
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

std::optional<StampedPose> latestPoseOf(const Slam& slam) {
  const std::optional<StampedPose> odometry = slam.parts().sessions.latestOdometry();
  if (!odometry) return std::nullopt;
  return StampedPose{odometry->stamp, slam.T_map_odom() * odometry->T_world_base};
}

std::vector<MixtureLandmark> landmarksOf(const Slam& slam) {
  return landmarksOf(slam.map(), slam.parts().graph);
}

const std::vector<MapHypothesis>& hypothesesOf(const Slam& slam) {
  static const std::vector<MapHypothesis> kNone;
  return slam.parts().mapper ? slam.parts().mapper->hypotheses() : kNone;
}

}  // namespace semantic_mht_slam
