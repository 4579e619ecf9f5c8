#include "semantic_mht_slam/ros/markers.h"

#include "semantic_mht_slam/ros/conversions.h"

namespace semantic_mht_slam {
namespace {

std_msgs::ColorRGBA toColor(const ClassInfo& info) {
  const std::array<double, 3> rgb = info.rgb();
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(rgb[0]);
  color.g = static_cast<float>(rgb[1]);
  color.b = static_cast<float>(rgb[2]);
  color.a = 0.9F;
  return color;
}

/// Large enough to be seen from above a whole town; thin things stay thinner than others.
Eigen::Vector3d displaySize(const Detection& detection, const ClassInfo& info) {
  if (detection.size_m) return detection.size_m->cwiseMax(0.1);
  return info.transition == Transition::kDirac ? Eigen::Vector3d(1.0, 1.0, 4.0) : Eigen::Vector3d(2.5, 2.5, 2.0);
}

}  // namespace

visualization_msgs::MarkerArray toObjectMarkers(const Frame& frame, const Pose& T_map_odom, const ClassTable& classes,
                                                const std::string& map_frame) {
  visualization_msgs::MarkerArray array;
  visualization_msgs::Marker marker;
  marker.header.frame_id = map_frame;
  marker.header.stamp = toRosTime(frame.stamp);
  marker.action = visualization_msgs::Marker::DELETEALL;
  array.markers.push_back(marker);
  marker.action = visualization_msgs::Marker::ADD;
  marker.type = visualization_msgs::Marker::CUBE;
  const Pose T_map_base = T_map_odom * frame.T_odom_base;
  for (const Detection& detection : frame.detections) {
    const ClassInfo& info = classes[detection.class_index];
    marker.ns = info.name;
    marker.id = detection.row;
    marker.pose = toMessage(Pose{T_map_base.rotation, T_map_base * detection.position_m});
    const Eigen::Vector3d size = displaySize(detection, info);
    marker.scale.x = size.x();
    marker.scale.y = size.y();
    marker.scale.z = size.z();
    marker.color = toColor(info);
    array.markers.push_back(marker);
  }
  return array;
}

visualization_msgs::MarkerArray toBoxMarkers(const std::vector<ExtractedObject>& objects, const ClassTable& classes,
                                             const std_msgs::Header& header) {
  constexpr float kOpacity = 0.45F;  // the points inside remain visible
  constexpr double kThinnest_m = 0.1;
  visualization_msgs::MarkerArray array;
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.action = visualization_msgs::Marker::DELETEALL;
  array.markers.push_back(marker);
  marker.action = visualization_msgs::Marker::ADD;
  marker.type = visualization_msgs::Marker::CUBE;
  for (const ExtractedObject& object : objects) {
    const ClassInfo& info = classes[object.detection.class_index];
    marker.ns = info.name;
    marker.id = object.detection.row;
    marker.pose = toMessage(Pose{Eigen::Quaterniond::Identity(), 0.5 * (object.box_min_m + object.box_max_m)});
    const Eigen::Vector3d size = (object.box_max_m - object.box_min_m).cwiseMax(kThinnest_m);
    marker.scale.x = size.x();
    marker.scale.y = size.y();
    marker.scale.z = size.z();
    marker.color = toColor(info);
    marker.color.a = kOpacity;
    array.markers.push_back(marker);
  }
  return array;
}

}  // namespace semantic_mht_slam
