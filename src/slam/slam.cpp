#include "semantic_mht_slam/slam/slam.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "semantic_mht_slam/common/stopwatch.h"

namespace semantic_mht_slam {

namespace {

const std::vector<std::pair<std::string, Method>> kMethods = {
    {"odometry", Method::kOdometry}, {"ukf", Method::kUkf}, {"mhm", Method::kMhm}, {"dpmhm", Method::kDpmhm}};

constexpr double kSensorReach_m = 60.0;
constexpr double kGraphShift_m = 10.0;  // as far as the graph may move a landmark in its submap

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
  describe(config.mapper, fields);
  describe(config.back_end, fields);
  fields.group("localization", config.localization);
}

Slam::Slam(const SlamConfig& config, const ClassTable& classes)
    : method_(config.method),
      assembler_(config.input),
      rng_(config.seed),
      odometry_noise_{config.mapper.submap.odometry_stddev_m, config.mapper.submap.odometry_stddev_rad},
      keyframe_config_(config.back_end.keyframe),
      keep_prob_(config.mapper.detection.keep_prob),
      map_(config.mapper.detection.keep_prob),
      localizer_config_(config.localization) {
  if (config.method == Method::kOdometry) return;
  mapper_.emplace(config.mapper, classes);
  back_end_.emplace(config.back_end, odometry_noise_, classes);
  const SubmapConfig& submap = config.mapper.submap;  // what is within its propagation is carried on by the mapper
  const double earlier_m = std::max(config.back_end.revisit.min_driven_m, submap.propagation_m);
  earlier_after_submaps_ = static_cast<int>(earlier_m / submap.length_m) + 2;
  if (!config.back_end.close_loops) return;
  mapper_->setEarlierMapProvider([this](const Pose& T_odom_submap) { return earlierMap(T_odom_submap); });
}

bool Slam::addOdometry(const StampedPose& T_odom_base) {
  if (!assembler_.addOdometry(T_odom_base)) return false;
  odometry_.push_back(T_odom_base);
  processReadyFrames();
  return true;
}

void Slam::addDetections(Stamp stamp, Detections detections) {
  assembler_.addDetections(stamp, std::move(detections));
  processReadyFrames();
}

void Slam::processReadyFrames() {
  while (auto frame = assembler_.next()) {
    if (mapper_ && latest_frame_) {
      driven_m_ += (frame->T_odom_base.translation_m - latest_frame_->T_odom_base.translation_m).norm();
    }
    if (localizer_) localizeBy(*frame);
    if (mapper_ && !localizer_) {
      map(*frame);
      if (is_place_known_) follow();
    }
    latest_frame_ = std::move(frame);
  }
}

void Slam::map(const Frame& frame) {
  const Stopwatch watch;
  auto submap = mapper_->add(frame.index, frame.stamp, frame.T_odom_base, frame.detections, rng_);
  mapping_s_ += watch.elapsed_s();
  if (submap) take(std::move(*submap));
  if (submap_frames_.empty()) submap_driven_m_ = driven_m_;
  submap_frames_.push_back(frame);
}

void Slam::endSubmap() {
  if (auto submap = mapper_->finish()) take(std::move(*submap));
}

void Slam::take(Submap submap) {
  for (Frame& frame : submap_frames_) {
    for (Detection& detection : frame.detections) detection = mapper_->corrected(detection);
  }
  const auto detector = [this](const Detection& detection) { return mapper_->detectorCov(detection); };
  auto keyframes = cutIntoKeyframes(submap, submap_frames_, submap_driven_m_, keep_prob_, {odometry_noise_, detector},
                                    keyframe_config_);
  submap_frames_.clear();
  const std::size_t first_new = back_end_->keyframes().keyframes.size();
  const std::vector<MergedLandmark> merged = back_end_->add(std::move(keyframes), submap, prediction_);
  prediction_ = std::move(next_prediction_);
  map_.add(std::make_shared<const Submap>(std::move(submap)));
  for (const auto& [gone, survivor] : merged) map_.merge(gone, survivor);
  is_place_known_ = isKnownSince(first_new);
}

EarlierMap Slam::earlierMap(const Pose& T_odom_submap) {
  next_prediction_ = back_end_->predict(T_odom_submap);
  const AlignmentPrior& prior = next_prediction_.prior;
  EarlierMap earlier;
  earlier.stddev_xy_m = prior.stddev_xy_m;
  earlier.stddev_z_m = prior.stddev_z_m;
  earlier.stddev_yaw_rad = prior.stddev_yaw_rad;
  const Pose T_submap_map = prior.T_a_b.inverse();
  const double radius_m = kSensorReach_m + 3.0 * prior.stddev_xy_m;
  const int newest = static_cast<int>(map_.submaps().size()) - earlier_after_submaps_;
  const auto is_within = [&](const Eigen::Vector3d& position_m, double distance_m) {
    return (position_m - prior.T_a_b.translation_m).head<2>().norm() <= distance_m;
  };
  for (int submap = 0; submap < static_cast<int>(map_.submaps().size()); ++submap) {
    const Pose T_map_seen = T_map_submap(submap);
    if (!is_within(T_map_seen.translation_m, radius_m + kGraphShift_m + map_.reach_m(submap))) continue;
    map_.forEachLandmarkOf(submap, [&](const MixtureLandmark& seen) {
      if (seen.last_submap > newest || !is_within(T_map_seen * seen.position.mean_m, radius_m + kGraphShift_m)) return;
      const MixtureLandmark landmark = inMap(submap, seen);
      if (!is_within(landmark.position.mean_m, radius_m)) return;
      earlier.landmarks.push_back(transformed(T_submap_map, landmark));
    });
  }
  if (submap_frames_.empty()) prediction_ = next_prediction_;  // no submap before it is still being finished
  return earlier;
}

void Slam::finish() {
  if (!mapper_) return;
  endSubmap();
  back_end_->finish();
}

const std::vector<MapHypothesis>& Slam::hypotheses() const {
  static const std::vector<MapHypothesis> kNone;
  return mapper_ ? mapper_->hypotheses() : kNone;
}

Pose Slam::T_map_submap(int submap) const {
  return back_end_ ? back_end_->T_map_submap(submap) : map_.submaps()[static_cast<std::size_t>(submap)]->T_odom_submap;
}

/// Landmarks of the pose graph stand where the graph has them.
MixtureLandmark Slam::inMap(int submap, const MixtureLandmark& seen) const {
  MixtureLandmark landmark = transformed(T_map_submap(submap), seen);
  const auto position_m = back_end_ ? back_end_->landmark(landmark.id) : std::optional<Eigen::Vector3d>();
  if (!position_m) return landmark;
  const Eigen::Vector3d shift_m = *position_m - landmark.position.mean_m;
  landmark.position.mean_m += shift_m;
  for (MixtureComponent& component : landmark.components) component.position.mean_m += shift_m;
  return landmark;
}

std::vector<MixtureLandmark> Slam::landmarks() const {
  std::vector<MixtureLandmark> landmarks;
  map_.forEachLandmark(
      [&](int submap, const MixtureLandmark& landmark) { landmarks.push_back(inMap(submap, landmark)); });
  auto merged_into = map_.mergedInto();
  for (MixtureLandmark& landmark : landmarks) landmark.merged_ids = std::move(merged_into[landmark.id]);
  return landmarks;
}

}  // namespace semantic_mht_slam
