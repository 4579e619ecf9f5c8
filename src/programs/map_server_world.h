#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/MergeStatus.h>
#include <semantic_mht_slam/SemanticMap.h>

#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/merging/map_merger.h"

#include "map_server_maps.h"

namespace semantic_mht_slam {

/// What is common to all worlds of a server.
struct WorldSettings {
  SlamConfig slam;
  ClassTable classes;
  std::string frame;
};

/// What came of the maps of a server. Does not change.
class World {
 public:
  /// Of no map.
  explicit World(WorldSettings settings) : settings_(std::move(settings)) {}

  /// Of the maps that can be used and were not removed. `progress` may throw to give up. Pairs of maps that are in the
  /// memory are not compared again.
  World(WorldSettings settings, const std::vector<ServedMap>& served, PairMemory& memory,
        const MergeProgress& progress);

  bool isEmpty() const { return maps_.empty(); }

  SemanticMap map() const;

  /// Of every map in it: world -> its frame, as it is where that map ends.
  std::vector<geometry_msgs::TransformStamped> transforms() const;

  /// Landmarks, and where each map in it was driven.
  visualization_msgs::MarkerArray markers() const;

  /// `served` as it is now, of which the world may know less.
  MergeStatus status(const std::vector<ServedMap>& served) const;

  /// As a map file holds it. Throws InputError if there is none.
  SavedMap saved() const;

 private:
  struct Known {
    std::size_t generation = 0;
    std::size_t place = 0;  ///< in `maps_`
    std::string frame;
  };

  const JoinedMap& joined() const { return *result_.groups.front().joined; }
  MapStatus statusOf(const ServedMap& served) const;
  visualization_msgs::Marker path(std::size_t member, double symbol_m) const;
  static visualization_msgs::Marker label(const visualization_msgs::Marker& path, double symbol_m);

  const WorldSettings settings_;
  std::vector<std::shared_ptr<const SlamParts>> held_;
  std::vector<MergeMap> maps_;
  std::map<std::string, Known> known_;  ///< by name
  MergeResult result_;
  std::vector<MixtureLandmark> landmarks_;
};

}  // namespace semantic_mht_slam
