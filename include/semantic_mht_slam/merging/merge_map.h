#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "semantic_mht_slam/place/pair_descriptor.h"
#include "semantic_mht_slam/registration/registration.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// How far apart two keyframes may be from where a map has them relative to each other.
struct KeyframeDrift {
  double xy_m = 0.0;  ///< standard deviation, each axis
  double yaw_rad = 0.0;
};

/// What is seen around a keyframe.
struct MapWindow {
  KeyframeId keyframe;
  Scene scene;  ///< base frame of the keyframe; each landmark once, by its id in the map
  PairDescriptor descriptor;
};

/// Landmarks next to each other that bear witness together; every landmark is in one tile at most.
struct MapTile {
  KeyframeId keyframe;
  Pose T_keyframe_tile;                   ///< its middle; turned as the keyframe is
  std::vector<RegistrationPoint> points;  ///< tile frame
  std::vector<LandmarkId> landmarks;      ///< ids in the map, in the same order
};

/// Settings that are common to all maps that are compared.
struct MergeSettings {
  SlamConfig slam;  ///< with the lengths of the detector
  ClassTable classes;
  double range_factor = 1.0;
};

/// A finished map, and what is asked of it when it is compared with others. Holds what it was given.
class MergeMap {
 public:
  MergeMap(std::string name, const Slam& slam) : name_(std::move(name)), parts_(&slam.parts()) {}
  MergeMap(std::string name, const SlamParts& parts) : name_(std::move(name)), parts_(&parts) {}

  const std::string& name() const { return name_; }
  const SlamParts& parts() const { return *parts_; }
  const Map& map() const { return parts_->map; }

  /// Makes windows, tiles and points. Needed before the rest is asked for.
  void prepare(const MergeSettings& settings, double window_m, double spacing_m, int tile_landmarks,
               int min_tile_landmarks);

  const std::vector<MapWindow>& windows() const { return windows_; }
  const std::vector<MapTile>& tiles() const { return tiles_; }

  /// Every landmark of the map once, map frame, by rising id.
  const std::vector<RegistrationPoint>& points() const { return points_; }
  const std::vector<LandmarkId>& pointIds() const { return point_ids_; }

  /// Distance driven between two keyframes.
  double driven_m(KeyframeId a, KeyframeId b) const;

  KeyframeDrift drift(KeyframeId a, KeyframeId b) const;

  /// The keyframe that is nearest to a position of the map, seen from above; none in an empty map.
  KeyframeId nearestKeyframe(const Eigen::Vector3d& position_m) const;

 private:
  std::vector<KeyframeId> around(KeyframeId keyframe, double reach_m) const;
  Scene sceneAround(KeyframeId keyframe, double reach_m) const;
  void makeWindows(const MergeSettings& settings, double window_m, double spacing_m);
  void makeTiles(const ClassTable& classes, double reach_m, int tile_landmarks, int min_tile_landmarks);
  void makePoints();

  std::string name_;
  const SlamParts* parts_;
  OdometryModel odometry_;
  std::vector<MapWindow> windows_;
  std::vector<MapTile> tiles_;
  std::vector<RegistrationPoint> points_;
  std::vector<LandmarkId> point_ids_;
};

}  // namespace semantic_mht_slam
