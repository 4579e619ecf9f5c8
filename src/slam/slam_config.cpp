#include <cmath>
#include <stdexcept>
#include <utility>

#include "semantic_mht_slam/slam/slam.h"

// The configuration, and how it is fitted to the detector.
namespace semantic_mht_slam {
namespace {

const std::vector<std::pair<std::string, Method>> kMethods = {
    {"odometry", Method::kOdometry}, {"ukf", Method::kUkf}, {"mhm", Method::kMhm}, {"dpmhm", Method::kDpmhm}};

/// What the vehicle moved on the way through frames.
Motion motionOf(const std::vector<Frame>& frames) {
  Motion motion;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    motion = motion + motionOf(frames[i - 1].T_odom_base.inverse() * frames[i].T_odom_base);
  }
  return motion;
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

SlamConfig fittedTo(const SlamConfig& config, double range_factor) {
  SlamConfig result = config;
  Fields fields;
  describe(result, fields);
  scaleLengths(range_factor, fields);
  OdometryConfig& odometry = result.mapper.odometry;
  if (!odometry.learn) return result;
  const double root = std::sqrt(range_factor);
  odometry.noise.along_m_per_sqrt_m *= root;
  odometry.noise.across_m_per_sqrt_m *= root;
  odometry.noise.up_m_per_sqrt_m *= root;
  odometry.noise.heading_rad_per_sqrt_m /= root;
  odometry.noise.tilt_rad_per_sqrt_m /= root;
  odometry.bend_stddev_rad_per_m /= range_factor;
  odometry.lever_stddev_m *= range_factor;
  odometry.range_offset_stddev_m *= range_factor;
  return result;
}

void fitParts(const SlamConfig& fitted, const ClassTable& classes, SlamParts& parts) {
  if (fitted.method == Method::kOdometry) return;
  parts.graph = MapGraph(fitted.back_end, classes);
  parts.mapper.emplace(fitted.mapper, classes, fitted.registration);
  parts.closer.emplace(fitted.back_end, classes, fitted.registration, parts.range_factor);
  parts.odometry = parts.mapper->odometryModel();
  parts.closer->setOdometry(parts.odometry);
}

void Slam::fitToDetector() {
  parts_.is_fitted = true;
  const double factor = parts_.detector_range.factor();
  if (factor != parts_.range_factor) {
    parts_.range_factor = factor;
    fitted_ = fittedTo(config_, factor);
    fitParts(fitted_, classes_, parts_);
  }
  const std::vector<Frame> frames = std::exchange(parts_.waiting, {});
  const Motion driven = parts_.driven;
  parts_.driven = driven - motionOf(frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0) {
      parts_.driven = parts_.driven + motionOf(frames[i - 1].T_odom_base.inverse() * frames[i].T_odom_base);
    }
    process(frames[i]);
  }
  parts_.driven = driven;
}

std::optional<MappedAhead> Slam::mapAhead() const {
  if (parts_.waiting.empty()) return std::nullopt;
  const SlamConfig fitted = fittedTo(config_, parts_.detector_range.factor());
  Mapper mapper(fitted.mapper, classes_, fitted.registration);
  Rng rng = parts_.rng;
  const Pose& T_odom_submap = parts_.waiting.front().T_odom_base;
  mapper.begin(T_odom_submap);
  for (const Frame& frame : parts_.waiting) {
    if (mapper.isFullAt(frame.T_odom_base)) break;
    mapper.add(frame, rng);
  }
  return MappedAhead{mapper.hypotheses(), T_map_odom() * T_odom_submap};
}

}  // namespace semantic_mht_slam
