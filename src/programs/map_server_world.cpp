#include "map_server_world.h"

#include <algorithm>
#include <utility>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/markers.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

namespace semantic_mht_slam {
namespace {

std_msgs::ColorRGBA colorOf(std::size_t member) {
  // Okabe and Ito's colours, which colour-blind readers can tell apart.
  constexpr std::array<std::array<float, 3>, 6> kColors{{{0.90F, 0.62F, 0.00F},
                                                         {0.34F, 0.71F, 0.91F},
                                                         {0.00F, 0.62F, 0.45F},
                                                         {0.94F, 0.89F, 0.26F},
                                                         {0.84F, 0.37F, 0.00F},
                                                         {0.80F, 0.47F, 0.65F}}};
  const auto& [r, g, b] = kColors[member % kColors.size()];
  std_msgs::ColorRGBA color;
  color.r = r;
  color.g = g;
  color.b = b;
  color.a = 1.0F;
  return color;
}

MapPair toMessage(const MergedPair& pair, const std::vector<MergeMap>& maps) {
  MapPair message;
  message.a = maps[pair.a].name();
  message.b = maps[pair.b].name();
  message.joined = pair.is_joined;
  message.posterior = pair.posterior;
  message.no_overlap = pair.overlap.none_prob;
  message.closures = static_cast<std::uint32_t>(pair.closures);
  message.reason = pair.reason;
  return message;
}

}  // namespace

World::World(WorldSettings settings, const std::vector<ServedMap>& served, PairMemory& memory,
             const MergeProgress& progress)
    : settings_(std::move(settings)) {
  for (const ServedMap& map : served) {
    if (map.is_removed || !map.parts) continue;
    known_[map.name] = {map.generation, maps_.size(), map.frame.empty() ? map.name + "/map" : map.frame};
    held_.push_back(map.parts);
    maps_.emplace_back(map.name, *map.parts);
  }
  if (maps_.empty()) return;
  result_ = mergeMaps(maps_, settings_.slam, settings_.classes, {}, progress, &memory);
  landmarks_ = landmarksOf(joined());
}

SemanticMap World::map() const {
  const std::size_t submaps = isEmpty() ? 0 : joined().parts.map.submaps().size();
  return toMessage(toStamp(ros::Time::now()), settings_.frame, settings_.classes, landmarks_, submaps);
}

std::vector<geometry_msgs::TransformStamped> World::transforms() const {
  std::vector<geometry_msgs::TransformStamped> transforms;
  if (isEmpty()) return transforms;
  for (const JoinedMember& member : joined().members) {
    const Map& own = member.map->map();
    const KeyframeId newest(own.keyframes().size() - 1);
    const KeyframeId in_world(newest.index() + member.first_keyframe);
    const Pose T_world_map = joined().parts.map.T_map_keyframe(in_world) * own.T_map_keyframe(newest).inverse();
    const std::string& frame = known_.at(member.map->name()).frame;
    transforms.push_back(toTransform({toStamp(ros::Time::now()), T_world_map}, settings_.frame, frame));
  }
  return transforms;
}

visualization_msgs::Marker World::path(std::size_t member, double symbol_m) const {
  visualization_msgs::Marker marker;
  marker.header.frame_id = settings_.frame;
  marker.ns = joined().members[member].map->name();
  marker.type = visualization_msgs::Marker::LINE_STRIP;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 0.5 * symbol_m;
  marker.color = colorOf(member);
  const Map& all = joined().parts.map;
  const std::size_t first = joined().members[member].first_keyframe;
  for (std::size_t k = 0; k < joined().members[member].map->map().keyframes().size(); ++k) {
    marker.points.push_back(toMessage(all.T_map_keyframe(KeyframeId(first + k))).position);
  }
  return marker;
}

/// The name of a map at its beginning.
visualization_msgs::Marker World::label(const visualization_msgs::Marker& path, double symbol_m) {
  visualization_msgs::Marker marker = path;
  marker.id = 1;
  marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  marker.text = path.ns;
  marker.scale.z = 8.0 * symbol_m;
  marker.pose.position = path.points.front();
  marker.pose.position.z += 4.0 * symbol_m;
  marker.points.clear();
  return marker;
}

visualization_msgs::MarkerArray World::markers() const {
  const SemanticMap shown = map();
  const double factor = isEmpty() ? 1.0 : joined().parts.range_factor;
  const double symbol_m = symbolSize(factor, shown);
  visualization_msgs::MarkerArray array = toLandmarkMarkers(shown, settings_.classes, symbol_m, LiveConfig());
  if (isEmpty()) return array;
  for (std::size_t member = 0; member < joined().members.size(); ++member) {
    array.markers.push_back(path(member, symbol_m));
    array.markers.push_back(label(array.markers.back(), symbol_m));
  }
  return array;
}

MapStatus World::statusOf(const ServedMap& served) const {
  MapStatus status;
  status.name = served.name;
  status.source = served.source;
  if (served.parts) {
    const Map& map = served.parts->map;
    status.submaps = static_cast<std::uint32_t>(map.submaps().size());
    status.keyframes = static_cast<std::uint32_t>(map.keyframes().size());
    status.driven = map.keyframes().back().driven_m;
  }
  const auto known = known_.find(served.name);
  if (served.is_removed) {
    status.state = MapStatus::REMOVED;
  } else if (!served.parts) {
    status.state = MapStatus::UNUSABLE;
    status.reason = served.problem;
  } else if (known == known_.end() || known->second.generation != served.generation) {
    status.state = MapStatus::WAITING;
  } else {
    const std::size_t place = known->second.place;
    const std::vector<std::size_t>& largest = result_.groups.front().maps;
    const bool is_in = std::find(largest.begin(), largest.end(), place) != largest.end();
    status.state = is_in ? MapStatus::JOINED : MapStatus::APART;
    if (!is_in) status.reason = result_.reasons[place];
    if (!is_in && status.reason.empty()) status.reason = "belongs to other maps that are apart from the largest group";
  }
  if (served.parts && !served.problem.empty()) status.reason = served.problem;
  return status;
}

MergeStatus World::status(const std::vector<ServedMap>& served) const {
  MergeStatus status;
  status.header.frame_id = settings_.frame;
  status.header.stamp = ros::Time::now();
  status.landmarks = static_cast<std::uint32_t>(landmarks_.size());
  for (const ServedMap& map : served) status.maps.push_back(statusOf(map));
  for (const MergedPair& pair : result_.pairs) status.pairs.push_back(toMessage(pair, maps_));
  return status;
}

SavedMap World::saved() const {
  if (isEmpty()) throw InputError("there is no map to save");
  const MergeSettings settings = mergeSettings(maps_, settings_.slam, settings_.classes);
  const SlamParts& parts = joined().parts;
  return {stateOf(settings.slam, parts), landmarks_, trajectoryOf(parts.sessions.record(parts.map)),
          parts.map.submaps().size()};
}

}  // namespace semantic_mht_slam
