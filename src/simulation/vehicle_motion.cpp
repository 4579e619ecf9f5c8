#include "semantic_mht_slam/simulation/vehicle_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "semantic_mht_slam/simulation/wander.h"

namespace semantic_mht_slam {
namespace {

constexpr double kWanderLength_m = 40.0;
constexpr double kTiltTime_s = 1.0;
constexpr double kCreepSpeed_mps = 0.5;  // slowest while moving, so that every stop is reached and left
constexpr double kStopBeforeCorner_m = 10.0;
constexpr double kCurvatureStep_m = 1.0;
/// A right angle smoothed with a Gaussian of deviation s has the radius sqrt(pi) / 2 s at its tip.
constexpr double kSmoothingPerRadius = 1.128;

using Line = std::vector<Eigen::Vector2d>;

/// Centre lines of the legs one after another. `corners` gets the indices of the points where legs meet.
Line joinLegs(const StreetNetwork& network, const std::vector<Leg>& legs, std::vector<std::size_t>& corners) {
  Line points;
  for (const Leg& leg : legs) {
    Line line = network.streets[static_cast<std::size_t>(leg.street)].center_line_m;
    if (leg.reversed) std::reverse(line.begin(), line.end());
    if (!points.empty()) {
      corners.push_back(points.size() - 1);
      line.erase(line.begin());
    }
    points.insert(points.end(), line.begin(), line.end());
  }
  return points;
}

/// Gaussian average over neighbours (about 1 m apart). The ends,
/// which lack neighbours, are drawn inwards a little.
Line smoothed(const Line& points, double stddev_m) {
  const int reach = static_cast<int>(std::ceil(3.0 * stddev_m));
  Line result(points.size());
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0.0;
    for (int j = std::max(0, i - reach); j <= std::min(static_cast<int>(points.size()) - 1, i + reach); ++j) {
      const double weight = std::exp(-0.5 * (i - j) * (i - j) / (stddev_m * stddev_m));
      sum += weight * points[static_cast<std::size_t>(j)];
      weights += weight;
    }
    result[static_cast<std::size_t>(i)] = sum / weights;
  }
  return result;
}

Eigen::Vector2d leftAt(const Line& points, std::size_t i) {
  return leftOf((points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1]).normalized());
}

/// Moved across by noise, one value a point (about 1 m); rough until it is smoothed.
Line wandering(const Line& points, const RouteConfig& config, Rng& rng) {
  Wander wander(config.lateral_wander_stddev_m, kWanderLength_m, rng);
  Line result;
  for (std::size_t i = 0; i < points.size(); ++i)
    result.push_back(points[i] + wander.next(1.0, rng) * leftAt(points, i));
  return result;
}

Line shiftedRight(const Line& points, double distance_m) {
  Line result;
  for (std::size_t i = 0; i < points.size(); ++i) result.push_back(points[i] - distance_m * leftAt(points, i));
  return result;
}

/// Points kPathStep_m apart on the line.
Line resampled(const Line& points) {
  Line result;
  double next_m = 0.0;  // from points[i - 1]
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step = (points[i] - points[i - 1]).norm();
    while (next_m < step) {
      result.push_back(points[i - 1] + next_m / step * (points[i] - points[i - 1]));
      next_m += kPathStep_m;
    }
    next_m -= step;
  }
  return result;
}

double curvature(const VehiclePath& path, double along_m) {
  const Eigen::Vector2d before = path.at(along_m - kCurvatureStep_m).direction;
  const Eigen::Vector2d after = path.at(along_m + kCurvatureStep_m).direction;
  const double turn = std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
  return std::abs(turn) / (2.0 * kCurvatureStep_m);
}

/// Indices of the path points at which the vehicle stops.
std::vector<std::size_t> drawStops(const VehiclePath& path, const RouteConfig& config, Rng& rng) {
  std::vector<std::size_t> stops;
  for (const double corner_m : path.corners_m) {
    const bool stop = rng.bernoulli(config.stop_prob);
    const double place_m = corner_m - kStopBeforeCorner_m;
    if (stop && place_m > kStopBeforeCorner_m) stops.push_back(static_cast<std::size_t>(place_m / kPathStep_m));
  }
  return stops;
}

/// Speed at each point of the path within the limits of curves, stops and acceleration.
std::vector<double> speedProfile(const VehiclePath& path, const std::vector<std::size_t>& stops,
                                 const RouteConfig& config) {
  std::vector<double> speed(path.points_m.size());
  for (std::size_t i = 0; i < speed.size(); ++i) {
    const double bend = curvature(path, static_cast<double>(i) * kPathStep_m);
    speed[i] = std::min(config.cruise_speed_mps, std::sqrt(config.lateral_acceleration_mps2 / std::max(bend, 1e-6)));
  }
  for (const std::size_t stop : stops) speed[stop] = kCreepSpeed_mps;
  const double gain = 2.0 * config.acceleration_mps2 * kPathStep_m;
  for (std::size_t i = 1; i < speed.size(); ++i) {
    speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + gain));
  }
  for (std::size_t i = speed.size() - 1; i > 0; --i) {
    speed[i - 1] = std::min(speed[i - 1], std::sqrt(speed[i] * speed[i] + gain));
  }
  return speed;
}

/// Speed between two points of the path: its square is linear in the distance, as under constant acceleration.
double speedAt(const std::vector<double>& speed, double along_m) {
  const double place = along_m / kPathStep_m;
  const std::size_t i = std::min(static_cast<std::size_t>(place), speed.size() - 2);
  const double fraction = std::min(1.0, place - static_cast<double>(i));
  return std::sqrt((1.0 - fraction) * speed[i] * speed[i] + fraction * speed[i + 1] * speed[i + 1]);
}

/// Distance along the path at each frame.
std::vector<double> driveAlong(const VehiclePath& path, const RouteConfig& config, Rng& rng) {
  const std::vector<std::size_t> stops = drawStops(path, config, rng);
  const std::vector<double> speed = speedProfile(path, stops, config);
  const double end_m = std::min(config.length_m, path.length());
  std::vector<double> along;
  std::size_t next_stop = 0;
  int waiting = 0;
  for (double s = 0.0; s <= end_m;) {
    along.push_back(s);
    if (next_stop < stops.size() && s >= static_cast<double>(stops[next_stop]) * kPathStep_m) {
      waiting = static_cast<int>(rng.uniform(0.0, config.stop_duration_max_s) * config.frame_rate_hz);
      ++next_stop;
    }
    if (waiting > 0) {
      --waiting;
      continue;
    }
    s += speedAt(speed, s) / config.frame_rate_hz;
  }
  return along;
}

Pose poseOnGround(const StreetPoint& point, const Terrain& terrain, double sensor_height_m, double pitch_rad,
                  double roll_rad) {
  const Eigen::Vector2d slope = terrain.gradient(point.position_m);
  const double yaw = std::atan2(point.direction.y(), point.direction.x());
  const double pitch = -std::atan(slope.dot(point.direction)) + pitch_rad;
  const double roll = std::atan(slope.dot(leftOf(point.direction))) + roll_rad;
  Pose pose;
  pose.rotation =
      (Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())) *
       Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .normalized();
  pose.translation_m << point.position_m, terrain.height(point.position_m) + sensor_height_m;
  return pose;
}

}  // namespace

double VehiclePath::length() const {
  return points_m.empty() ? 0.0 : static_cast<double>(points_m.size() - 1) * kPathStep_m;
}

StreetPoint VehiclePath::at(double along_m) const {
  const double place = std::clamp(along_m, 0.0, length()) / kPathStep_m;
  const std::size_t i = std::min(static_cast<std::size_t>(place), points_m.size() - 2);
  const double fraction = place - static_cast<double>(i);
  // tangents at the two points around the place, so that the direction has no steps
  const Eigen::Vector2d first = points_m[i + 1] - points_m[i == 0 ? 0 : i - 1];
  const Eigen::Vector2d second = points_m[std::min(i + 2, points_m.size() - 1)] - points_m[i];
  const Eigen::Vector2d direction = (1.0 - fraction) * first.normalized() + fraction * second.normalized();
  return {points_m[i] + fraction * (points_m[i + 1] - points_m[i]), direction.normalized()};
}

VehiclePath smoothPath(const StreetNetwork& network, const std::vector<Leg>& legs, const RouteConfig& config, Rng rng) {
  std::vector<std::size_t> corners;
  const Line rough = wandering(joinLegs(network, legs, corners), config, rng);
  const Line line = shiftedRight(smoothed(rough, kSmoothingPerRadius * config.corner_radius_m), config.lane_offset_m);
  VehiclePath path;
  double along = 0.0;
  std::size_t corner = 0;
  for (std::size_t i = 1; i < line.size() && corner < corners.size(); ++i) {
    along += (line[i] - line[i - 1]).norm();
    if (i != corners[corner]) continue;
    path.corners_m.push_back(along);
    ++corner;
  }
  path.points_m = resampled(line);
  return path;
}

VehicleMotion drivePath(const VehiclePath& path, const Terrain& terrain, const RouteConfig& config, Rng rng) {
  Rng speed_rng = rng.fork("speed");
  Rng tilt_rng = rng.fork("tilt");
  VehicleMotion motion;
  motion.along_m = driveAlong(path, config, speed_rng);
  Wander pitch(config.tilt_stddev_rad, kTiltTime_s, tilt_rng);
  Wander roll(config.tilt_stddev_rad, kTiltTime_s, tilt_rng);
  for (std::size_t k = 0; k < motion.along_m.size(); ++k) {
    motion.stamps.push_back(stampFromSeconds(static_cast<double>(k) / config.frame_rate_hz));
    const double pitch_rad = pitch.next(1.0 / config.frame_rate_hz, tilt_rng);
    const double roll_rad = roll.next(1.0 / config.frame_rate_hz, tilt_rng);
    motion.T_world_base.push_back(
        poseOnGround(path.at(motion.along_m[k]), terrain, config.sensor_height_m, pitch_rad, roll_rad));
  }
  return motion;
}

}  // namespace semantic_mht_slam
