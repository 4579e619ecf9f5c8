#include "semantic_mht_slam/ros/graph_view.h"

#include <algorithm>
#include <set>

#include "semantic_mht_slam/bags/conversions.h"

namespace semantic_mht_slam {
namespace {

// In symbols.
constexpr double kOutlineMargin = 3.0;
constexpr double kLift = 3.0;   // above the trajectory, so that both are seen
constexpr double kPlace = 3.0;  // closures are short lines: seen from above a town, their places stand out

std_msgs::ColorRGBA makeColor(float r, float g, float b, float a) {
  std_msgs::ColorRGBA color;
  color.r = r;
  color.g = g;
  color.b = b;
  color.a = a;
  return color;
}

const std_msgs::ColorRGBA kGreen = makeColor(0.2F, 0.9F, 0.3F, 1.0F);
const std_msgs::ColorRGBA kRed = makeColor(0.9F, 0.2F, 0.2F, 0.5F);
const std_msgs::ColorRGBA kOrange = makeColor(1.0F, 0.6F, 0.1F, 1.0F);
const std_msgs::ColorRGBA kGrey = makeColor(0.5F, 0.5F, 0.55F, 0.6F);

visualization_msgs::Marker makeLines(const std::string& name, int type, double width_m, const std::string& map_frame) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = map_frame;
  marker.ns = name;
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = width_m;
  marker.color = kGrey;
  return marker;
}

/// Markers without points would be errors in rviz, so what was shown is deleted instead.
visualization_msgs::MarkerArray makeArray(std::vector<visualization_msgs::Marker> markers) {
  visualization_msgs::MarkerArray array;
  for (visualization_msgs::Marker& marker : markers) {
    if (marker.points.empty()) marker.action = visualization_msgs::Marker::DELETE;
    array.markers.push_back(std::move(marker));
  }
  return array;
}

geometry_msgs::Point toPoint(const Eigen::Vector3d& point_m) {
  geometry_msgs::Point point;
  point.x = point_m.x();
  point.y = point_m.y();
  point.z = point_m.z();
  return point;
}

LoopClosure toMessage(const Map& map, ClosureId id, const std::string& map_frame) {
  const LoopClosureRecord& record = map.closures()[id];
  const Keyframe& query = map.keyframes()[record.query_keyframe];
  const Keyframe& match = map.keyframes()[record.match_keyframe];
  LoopClosure message;
  message.id = static_cast<std::uint32_t>(id.index());
  message.header.stamp = toRosTime(query.stamp);
  message.header.frame_id = map_frame;
  message.query_submap = static_cast<std::uint32_t>(query.submap.index());
  message.match_submap = static_cast<std::uint32_t>(match.submap.index());
  message.match_stamp = toRosTime(match.stamp);
  message.accepted = record.is_accepted;
  message.reason = record.reason;
  message.transform = toMessage(record.T_match_query, inFixedAxes(record.T_match_query, record.cov));
  message.histogram_divergence = record.place.histogram_divergence;
  message.descriptor_score = record.place.descriptor_score;
  message.topology_score = record.place.topology_score;
  message.scene_score = record.place.scene_score;
  message.loop_prob = record.place.loop_prob;
  message.verification_score = record.score;
  message.inliers = static_cast<std::uint32_t>(record.inliers);
  return message;
}

/// Submaps that the newest one was compared with.
std::set<SubmapId> comparedWithNewest(const Map& map) {
  std::set<SubmapId> compared;
  for (const LoopClosureRecord& record : map.closures()) {
    const bool is_newest = map.keyframes()[record.query_keyframe].submap == map.keyframes().back().submap;
    if (is_newest) compared.insert(map.keyframes()[record.match_keyframe].submap);
  }
  return compared;
}

/// Four edges around positions of a submap, along the submap's axes.
void addOutline(const Pose& T_map_submap, const std::vector<Eigen::Vector3d>& positions_m, double margin_m,
                visualization_msgs::Marker& m, const std_msgs::ColorRGBA& color) {
  if (positions_m.empty()) return;
  Eigen::AlignedBox3d box;
  const Pose T_submap_map = T_map_submap.inverse();
  for (const Eigen::Vector3d& position_m : positions_m) box.extend(T_submap_map * position_m);
  const Eigen::Vector3d low = box.min() - Eigen::Vector3d::Constant(margin_m);
  const Eigen::Vector3d high = box.max() + Eigen::Vector3d::Constant(margin_m);
  const double z = box.center().z();
  const Eigen::Vector3d corners[] = {
      {low.x(), low.y(), z}, {high.x(), low.y(), z}, {high.x(), high.y(), z}, {low.x(), high.y(), z}};
  for (int i = 0; i < 4; ++i) {
    m.points.push_back(toPoint(T_map_submap * corners[i]));
    m.points.push_back(toPoint(T_map_submap * corners[(i + 1) % 4]));
    m.colors.insert(m.colors.end(), 2, color);
  }
}

}  // namespace

std::vector<ClosureId> ClosureNews::takeNews(const Map& map) {
  std::vector<ClosureId> news;
  for (const ClosureId id : map.closures().ids()) {
    const bool is_accepted = map.closures()[id].is_accepted;
    if (known_.has(id) && known_[id] == is_accepted) continue;
    news.push_back(id);
    if (!known_.has(id)) known_.push_back(is_accepted);
    known_[id] = is_accepted;
  }
  return news;
}

std::vector<LoopClosure> toLoopClosures(const Map& map, const std::vector<ClosureId>& closures,
                                        const std::string& map_frame) {
  std::vector<LoopClosure> messages;
  for (const ClosureId id : closures) messages.push_back(toMessage(map, id, map_frame));
  return messages;
}

std::size_t acceptedClosures(const Map& map) {
  return static_cast<std::size_t>(std::count_if(map.closures().begin(), map.closures().end(),
                                                [](const auto& record) { return record.is_accepted; }));
}

visualization_msgs::MarkerArray toLoopMarkers(const Map& map, double symbol_m, const LiveConfig& live,
                                              const std::string& map_frame) {
  visualization_msgs::Marker accepted =
      makeLines("accepted", visualization_msgs::Marker::LINE_LIST, symbol_m, map_frame);
  visualization_msgs::Marker places =
      makeLines("places", visualization_msgs::Marker::SPHERE_LIST, kPlace * symbol_m, map_frame);
  places.scale.y = places.scale.z = kPlace * symbol_m;
  visualization_msgs::Marker refused =
      makeLines("refused", visualization_msgs::Marker::LINE_LIST, 0.3 * symbol_m, map_frame);
  accepted.color = places.color = kGreen;
  refused.color = kRed;
  for (const LoopClosureRecord& record : map.closures()) {
    if (!record.is_accepted && !live.refused_closures) continue;
    visualization_msgs::Marker& marker = record.is_accepted ? accepted : refused;
    for (const KeyframeId keyframe : {record.query_keyframe, record.match_keyframe}) {
      const Eigen::Vector3d& position_m = map.T_map_keyframe(keyframe).translation_m;
      marker.points.push_back(toPoint(position_m + Eigen::Vector3d(0.0, 0.0, kLift * symbol_m)));
    }
    if (record.is_accepted) places.points.push_back(accepted.points.back());
  }
  return makeArray({accepted, places, refused});
}

visualization_msgs::MarkerArray toSubmapMarkers(const Map& map, double symbol_m, const std::string& map_frame) {
  visualization_msgs::Marker outlines =
      makeLines("submaps", visualization_msgs::Marker::LINE_LIST, 0.6 * symbol_m, map_frame);
  if (map.submaps().empty()) return makeArray({outlines});
  const std::set<SubmapId> compared = comparedWithNewest(map);
  for (const SubmapId submap : map.submaps().ids()) {
    std::vector<Eigen::Vector3d> positions_m;
    for (const KeyframeId keyframe : map.keyframesOf(submap)) {
      positions_m.push_back(map.T_map_keyframe(keyframe).translation_m);
    }
    addOutline(map.T_map_submap(submap), positions_m, kOutlineMargin * symbol_m, outlines,
               compared.count(submap) > 0 ? kOrange : kGrey);
  }
  return makeArray({outlines});
}

visualization_msgs::MarkerArray toOdometryMarkers(const std::vector<Pose>& T_odom_base, double symbol_m,
                                                  const std::string& map_frame) {
  visualization_msgs::Marker line =
      makeLines("odometry", visualization_msgs::Marker::LINE_STRIP, 0.5 * symbol_m, map_frame);
  line.color = makeColor(0.85F, 0.35F, 0.75F, 0.8F);
  if (T_odom_base.size() < 2) return makeArray({line});
  for (const Pose& pose : T_odom_base) line.points.push_back(toPoint(pose.translation_m));
  return makeArray({line});
}

}  // namespace semantic_mht_slam
