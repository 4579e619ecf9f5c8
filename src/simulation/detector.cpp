#include "semantic_mht_slam/simulation/detector.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/simulation/spatial_grid.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMinRange_m = 1.0;
constexpr double kClutterHeight_m = -0.7;  // mean and deviation in the base frame, between road and eye level
constexpr double kClutterHeightStddev_m = 0.5;

/// A wall in the plane.
struct Wall {
  int landmark = 0;
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool crosses(const Wall& wall, const Eigen::Vector2d& eye, const Eigen::Vector2d& target) {
  const Eigen::Vector2d ray = target - eye;
  const Eigen::Vector2d along = wall.to - wall.from;
  return cross(ray, wall.from - eye) * cross(ray, wall.to - eye) < 0.0 &&
         cross(along, eye - wall.from) * cross(along, target - wall.from) < 0.0;
}

/// Classes a network takes an object for.
std::vector<TownClass> similarTo(TownClass town_class) {
  switch (town_class) {
    case TownClass::kVehicle:
      return {};
    case TownClass::kBuilding:
      return {TownClass::kFence};
    case TownClass::kFence:
      return {TownClass::kBuilding, TownClass::kVegetation};
    case TownClass::kVegetation:
      return {TownClass::kFence, TownClass::kTrunk};
    case TownClass::kTrunk:
      return {TownClass::kVegetation, TownClass::kPole};
    case TownClass::kPole:
      return {TownClass::kTrunk, TownClass::kTrafficSign};
    case TownClass::kTrafficSign:
      return {TownClass::kPole};
  }
  return {};
}

/// Whole millimetres, as a CSV file holds them; never -0.
Eigen::Vector3d roundedToMillimetres(const Eigen::Vector3d& position_m) {
  return position_m.unaryExpr([](double x) { return std::round(x * 1000.0) / 1000.0 + 0.0; });
}

class SimulatedDetector {
 public:
  SimulatedDetector(const std::vector<ScheduledLandmark>& landmarks, const Scenario& scenario,
                    const std::array<ClassIndex, kTownClassCount>& class_indices, const Rng& rng)
      : landmarks_(landmarks),
        classes_(scenario.classes),
        config_(scenario.detector),
        class_indices_(class_indices),
        rng_(rng),
        grid_(positionsOf(landmarks), 0.5 * scenario.detector.max_range_m),
        reach_m_(scenario.detector.max_range_m + longestSide(landmarks)) {
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      Rng hidden_rng = rng.fork("hidden", i);
      hidden_.emplace_back();
      for (std::size_t pass = 0; pass < landmarks[i].passes.size(); ++pass) {
        hidden_.back().push_back(hidden_rng.bernoulli(config_.hidden_pass_prob));
      }
    }
  }

  SimulatedFrame detect(int frame, const Pose& T_world_base, const std::vector<Eigen::Vector3d>& moving) const {
    const Rng rng = rng_.fork("frame", static_cast<std::uint64_t>(frame));
    SimulatedFrame result;
    if (rng.fork("missed").bernoulli(config_.missed_frame_prob)) return result;
    const Eigen::Vector2d eye = T_world_base.translation_m.head<2>();
    const Pose T_base_world = T_world_base.inverse();
    const std::vector<int> near = grid_.near(eye, reach_m_);
    const std::vector<Wall> walls = wallsAmong(near);
    for (const int i : near) {
      if (!isPresent(static_cast<std::size_t>(i), frame)) continue;
      const TownObject& object = landmarks_[static_cast<std::size_t>(i)].object;
      const Eigen::Vector3d seen = visiblePoint(object, eye);
      if (isBehindWall(walls, eye, seen, i)) continue;
      observe(object.town_class, T_base_world * seen, i, rng.fork("landmark", static_cast<std::uint64_t>(i)), result);
    }
    for (std::size_t i = 0; i < moving.size(); ++i) {
      if (isBehindWall(walls, eye, moving[i], kMovingId)) continue;
      observe(TownClass::kVehicle, T_base_world * moving[i], kMovingId, rng.fork("moving", i), result);
    }
    addClutter(rng.fork("clutter"), result);
    shuffle(rng.fork("order"), result);
    return result;
  }

 private:
  static std::vector<Eigen::Vector2d> positionsOf(const std::vector<ScheduledLandmark>& landmarks) {
    std::vector<Eigen::Vector2d> positions;
    positions.reserve(landmarks.size());
    for (const ScheduledLandmark& landmark : landmarks) positions.push_back(landmark.object.position_m.head<2>());
    return positions;
  }

  static double longestSide(const std::vector<ScheduledLandmark>& landmarks) {
    double longest = 0.0;
    for (const ScheduledLandmark& landmark : landmarks) {
      longest = std::max({longest, landmark.object.length_m, landmark.object.depth_m});
    }
    return longest;
  }

  /// Neither away nor hidden.
  bool isPresent(std::size_t landmark, int frame) const {
    const std::vector<Pass>& passes = landmarks_[landmark].passes;
    for (std::size_t i = 0; i < passes.size(); ++i) {
      if (frame >= passes[i].first_frame && frame <= passes[i].last_frame) return !hidden_[landmark][i];
    }
    return false;
  }

  std::vector<Wall> wallsAmong(const std::vector<int>& near) const {
    std::vector<Wall> walls;
    if (!config_.buildings_block_view) return walls;
    for (const int i : near) {
      const TownObject& object = landmarks_[static_cast<std::size_t>(i)].object;
      if (object.town_class != TownClass::kBuilding) continue;
      const Eigen::Vector2d half = 0.5 * object.length_m * object.direction;
      walls.push_back({i, object.position_m.head<2>() - half, object.position_m.head<2>() + half});
    }
    return walls;
  }

  Eigen::Vector3d visiblePoint(const TownObject& object, const Eigen::Vector2d& eye) const {
    Eigen::Vector3d seen = object.position_m;
    const double view = classes_[object.town_class].view_dependence;
    if (view > 0.0) seen.head<2>() += view * (visibleCentroid(object, eye) - seen.head<2>());
    return seen;
  }

  /// True if a building other than the object itself stands between.
  static bool isBehindWall(const std::vector<Wall>& walls, const Eigen::Vector2d& eye, const Eigen::Vector3d& target,
                           int own_id) {
    return std::any_of(walls.begin(), walls.end(), [&](const Wall& wall) {
      return wall.landmark != own_id && crosses(wall, eye, target.head<2>());
    });
  }

  /// Chance to detect an object of the class at a place of the base frame.
  double detectionProb(TownClass town_class, const Eigen::Vector3d& position_m) const {
    const double range = position_m.norm();
    if (range > config_.max_range_m || range < kMinRange_m) return 0.0;
    if (std::abs(std::atan2(position_m.y(), position_m.x())) > 0.5 * config_.field_of_view_rad) return 0.0;
    const TownClassConfig& config = classes_[town_class];
    return config.detection_prob / (1.0 + std::exp((range - config.half_range_m) / config_.range_falloff_m));
  }

  /// Detects, or misses, an object whose visible centroid is at `position_m` of the base frame.
  void observe(TownClass town_class, const Eigen::Vector3d& position_m, int id, Rng rng, SimulatedFrame& result) const {
    if (!rng.bernoulli(detectionProb(town_class, position_m))) return;
    const Eigen::Vector3d measured = position_m + measurementError(classes_[town_class], position_m, rng);
    const TownClass label = confused(town_class, rng);
    if (!rng.bernoulli(config_.split_prob)) return add(label, measured, id, result);
    const double angle = rng.uniform(-M_PI, M_PI);
    const double half = 0.5 * rng.uniform(0.0, config_.split_distance_m);
    const Eigen::Vector3d offset(half * std::cos(angle), half * std::sin(angle), 0.0);
    add(label, measured + offset, id, result);
    add(label, measured - offset, id, result);
  }

  Eigen::Vector3d measurementError(const TownClassConfig& config, const Eigen::Vector3d& position_m, Rng& rng) const {
    const double range = position_m.norm();
    const Eigen::Vector3d sight = position_m / range;
    const Eigen::Vector3d lateral = Eigen::Vector3d(-sight.y(), sight.x(), 0.0).normalized();
    const double along = config.range_bias_m + config.range_bias_per_m * range +
                         rng.normal(0.0, std::hypot(config.range_stddev_m, config_.range_stddev_per_m * range));
    const double across = rng.normal(0.0, config.lateral_stddev_m);
    const double up = config.height_bias_per_m * range + rng.normal(0.0, config.height_noise_stddev_m);
    return along * sight + across * lateral + up * Eigen::Vector3d::UnitZ();
  }

  TownClass confused(TownClass town_class, Rng& rng) const {
    const std::vector<TownClass> similar = similarTo(town_class);
    if (!rng.bernoulli(config_.confusion_prob) || similar.empty()) return town_class;
    return similar[rng.index(similar.size())];
  }

  /// Uniform over the area that is searched.
  void addClutter(Rng rng, SimulatedFrame& result) const {
    const std::uint64_t count = rng.poisson(config_.clutter_mean);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double range = std::max(kMinRange_m, config_.max_range_m * std::sqrt(rng.uniform()));
      const double azimuth = config_.field_of_view_rad * rng.uniform(-0.5, 0.5);
      const double height = rng.normal(kClutterHeight_m, kClutterHeightStddev_m);
      const TownClass label = static_cast<TownClass>(rng.index(kTownClassCount));
      add(label, {range * std::cos(azimuth), range * std::sin(azimuth), height}, kClutterId, result);
    }
  }

  void add(TownClass label, const Eigen::Vector3d& position_m, int id, SimulatedFrame& result) const {
    Detection detection;
    detection.class_index = class_indices_[static_cast<std::size_t>(label)];
    detection.position_m = roundedToMillimetres(position_m);
    result.detections.push_back(detection);
    result.truth_ids.push_back(id);
  }

  static void shuffle(Rng rng, SimulatedFrame& frame) {
    for (std::size_t left = frame.detections.size(); left > 1; --left) {
      const std::size_t pick = rng.index(left);
      std::swap(frame.detections[pick], frame.detections[left - 1]);
      std::swap(frame.truth_ids[pick], frame.truth_ids[left - 1]);
    }
    int row = 0;
    for (Detection& detection : frame.detections) detection.row = row++;
  }

  const std::vector<ScheduledLandmark>& landmarks_;
  const TownClassesConfig& classes_;
  const SimulatedDetectorConfig& config_;
  const std::array<ClassIndex, kTownClassCount>& class_indices_;
  Rng rng_;
  SpatialGrid grid_;
  double reach_m_;                         // the centre of a long object may be out of range while its near end is seen
  std::vector<std::vector<bool>> hidden_;  // by landmark and pass
};

}  // namespace

std::array<ClassIndex, kTownClassCount> townClassIndices(const ClassTable& table) {
  std::array<ClassIndex, kTownClassCount> indices{};
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::optional<ClassIndex> index = table.findName(kTownClassNames[i]);
    if (index) indices[i] = *index;
    if (!index) missing.emplace_back(kTownClassNames[i]);
  }
  if (missing.empty()) return indices;
  throw InputError("the simulator needs classes that the table lacks: " + joined(missing) + " (it has " +
                   table.names() + ")");
}

std::vector<SimulatedFrame> simulateDetections(const std::vector<ScheduledLandmark>& landmarks,
                                               const std::vector<std::vector<Eigen::Vector3d>>& traffic,
                                               const VehicleMotion& motion, const Scenario& scenario,
                                               const std::array<ClassIndex, kTownClassCount>& class_indices,
                                               const Rng& rng) {
  const SimulatedDetector detector(landmarks, scenario, class_indices, rng);
  std::vector<SimulatedFrame> frames;
  for (std::size_t k = 0; k < motion.T_world_base.size(); ++k) {
    frames.push_back(detector.detect(static_cast<int>(k), motion.T_world_base[k], traffic[k]));
  }
  return frames;
}

}  // namespace semantic_mht_slam
