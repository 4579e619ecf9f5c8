#include "semantic_mht_slam/slam/slam.h"

#include <memory>
#include <stdexcept>
#include <utility>

namespace semantic_mht_slam {

namespace {

const std::vector<std::pair<std::string, Method>> kMethods = {
    {"odometry", Method::kOdometry}, {"ukf", Method::kUkf}, {"mhm", Method::kMhm}, {"dpmhm", Method::kDpmhm}};

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
  fields.group("place", config.place);
}

Slam::Slam(const SlamConfig& config, const ClassTable& classes)
    : assembler_(config.input), rng_(config.seed), map_(config.mapper.detection.keep_prob) {
  if (config.method != Method::kOdometry) mapper_.emplace(config.mapper, classes);
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
    if (mapper_) {
      auto submap = mapper_->add(frame->index, frame->stamp, frame->T_odom_base, frame->detections, rng_);
      if (submap) map_.add(std::make_shared<const Submap>(std::move(*submap)));
    }
    latest_frame_ = std::move(frame);
  }
}

void Slam::finish() {
  if (!mapper_) return;
  if (auto submap = mapper_->finish()) map_.add(std::make_shared<const Submap>(std::move(*submap)));
}

const std::vector<MapHypothesis>& Slam::hypotheses() const {
  static const std::vector<MapHypothesis> kNone;
  return mapper_ ? mapper_->hypotheses() : kNone;
}

std::vector<StampedPose> Slam::trajectory() const {
  std::vector<StampedPose> trajectory;
  trajectory.reserve(odometry_.size());
  for (const auto& [stamp, T_odom_base] : odometry_) trajectory.push_back({stamp, T_map_odom() * T_odom_base});
  return trajectory;
}

std::optional<StampedPose> Slam::latestPose() const {
  if (odometry_.empty()) return std::nullopt;
  return StampedPose{odometry_.back().stamp, T_map_odom() * odometry_.back().T_world_base};
}

}  // namespace semantic_mht_slam
