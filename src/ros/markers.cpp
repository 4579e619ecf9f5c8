#include "semantic_mht_slam/ros/markers.h"

#include <algorithm>
#include <map>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

constexpr double kSymbolsAcross = 250.0;  // symbols of a map beside each other: still seen with all of it in view

std_msgs::ColorRGBA toColor(const ClassInfo& info) {
  const std::array<double, 3> rgb = info.rgb();
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(rgb[0]);
  color.g = static_cast<float>(rgb[1]);
  color.b = static_cast<float>(rgb[2]);
  color.a = 0.9F;
  return color;
}

/// Thin things stay thinner than others.
Eigen::Vector3d displaySize(const Detection& detection, const ClassInfo& info, double symbol_m) {
  if (detection.size_m) return detection.size_m->cwiseMax(0.1 * symbol_m);
  const bool is_thin = info.transition == Transition::kDirac;
  return symbol_m * (is_thin ? Eigen::Vector3d(1.0, 1.0, 4.0) : Eigen::Vector3d(2.5, 2.5, 2.0));
}

std_msgs::ColorRGBA vehicleColor() {
  std_msgs::ColorRGBA color;
  color.r = color.g = color.b = color.a = 1.0F;
  return color;
}

visualization_msgs::Marker clearingMarker(const std_msgs::Header& header) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.action = visualization_msgs::Marker::DELETEALL;
  return marker;
}

/// Adds the markers of one landmark after another.
class LandmarkDrawing {
 public:
  LandmarkDrawing(const SemanticMap& map, const ClassTable& classes, double symbol_m, const LiveConfig& live)
      : classes_(classes), symbol_m_(symbol_m), live_(live) {
    marker_.header = map.header;
    marker_.pose.orientation.w = 1.0;
    array_.markers.push_back(clearingMarker(map.header));
  }

  void add(const Landmark& landmark) {
    const std::optional<ClassIndex> index = classes_.findId(landmark.class_id);
    if (!index) return;
    const ClassInfo& info = classes_[*index];
    for (const GaussianComponent& component : landmark.components) {
      addEllipsoid(component, landmark.provisional ? kProvisionalOpacity : 1.0, info);
    }
    addBody(landmark, info);
    if (landmark.undecided) addAlternatives(landmark);
    if (live_.landmark_labels) addLabel(landmark, info);
  }

  visualization_msgs::MarkerArray take() {
    for (auto& [name, dots] : dots_) array_.markers.push_back(std::move(dots));
    return std::move(array_);
  }

 private:
  visualization_msgs::Marker& push(const std::string& name, int type) {
    array_.markers.push_back(marker_);
    array_.markers.back().ns = name;
    array_.markers.back().id = static_cast<int>(array_.markers.size());
    array_.markers.back().type = type;
    return array_.markers.back();
  }

  void addEllipsoid(const GaussianComponent& component, double opacity, const ClassInfo& info) {
    const Eigen::Matrix3d cov = Eigen::Map<const Eigen::Matrix3d>(component.covariance.data());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(cov);
    Eigen::Matrix3d rotation = axes.eigenvectors();
    if (rotation.determinant() < 0.0) rotation.col(0) *= -1.0;
    const Eigen::Vector3d size =
        (2.0 * live_.landmark_sigmas * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt()).cwiseMax(kLandmark * symbol_m_);
    std_msgs::ColorRGBA color = toColor(info);
    color.a = static_cast<float>(opacity * (0.2 + 0.7 * component.weight));
    if (size.maxCoeff() <= kLandmark * symbol_m_) return addDot(component.mean, color, info);
    visualization_msgs::Marker& marker = push(info.name, visualization_msgs::Marker::SPHERE);
    marker.pose = toMessage(Pose{Eigen::Quaterniond(rotation), positionOf(component.mean)});
    marker.scale.x = size.x();
    marker.scale.y = size.y();
    marker.scale.z = size.z();
    marker.color = color;
  }

  /// Ellipsoids of the smallest size are equal: one marker for those of a class is much cheaper to show.
  void addDot(const geometry_msgs::Point& position, const std_msgs::ColorRGBA& color, const ClassInfo& info) {
    const auto [found, is_new] = dots_.try_emplace(info.name, marker_);
    visualization_msgs::Marker& dots = found->second;
    if (is_new) {
      dots.ns = info.name;
      dots.type = visualization_msgs::Marker::SPHERE_LIST;
      dots.scale.x = dots.scale.y = dots.scale.z = kLandmark * symbol_m_;
    }
    dots.points.push_back(position);
    dots.colors.push_back(color);
  }

  /// A cylinder as large as the object, whose heading nobody knows; none where the symbol would hide it.
  void addBody(const Landmark& landmark, const ClassInfo& info) {
    const double across_m = 0.5 * (landmark.size.x + landmark.size.y);
    if (std::max(across_m, landmark.size.z) <= kLandmark * symbol_m_) return;
    visualization_msgs::Marker& marker = push("sizes", visualization_msgs::Marker::CYLINDER);
    marker.pose.position = landmark.position;
    marker.scale.x = marker.scale.y = std::max(across_m, kThinnest * symbol_m_);
    marker.scale.z = std::max(landmark.size.z, kThinnest * symbol_m_);
    marker.color = toColor(info);
    marker.color.a = kBodyOpacity;
  }

  void addAlternatives(const Landmark& landmark) {
    visualization_msgs::Marker& marker = push("undecided", visualization_msgs::Marker::LINE_LIST);
    marker.scale.x = 0.3 * symbol_m_;
    marker.color = undecided_color_;
    for (const GaussianComponent& component : landmark.components) {
      marker.points.push_back(landmark.position);
      marker.points.push_back(component.mean);
    }
  }

  void addLabel(const Landmark& landmark, const ClassInfo& info) {
    visualization_msgs::Marker& marker = push("labels", visualization_msgs::Marker::TEXT_VIEW_FACING);
    marker.pose.position = landmark.position;
    marker.pose.position.z += 2.5 * symbol_m_;
    marker.scale.z = 1.8 * symbol_m_;
    marker.color = undecided_color_;
    if (!landmark.undecided) marker.color = toColor(info);
    marker.text = info.name + " " + std::to_string(landmark.id);
    if (landmark.undecided) marker.text += "? " + formatFixed(100.0 * landmark.components.front().weight, 0) + " %";
  }

  static Eigen::Vector3d positionOf(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

  static constexpr double kLandmark = 2.0;  // symbols; smaller ones could not be seen or clicked
  static constexpr double kProvisionalOpacity = 0.5;
  static constexpr float kBodyOpacity = 0.3F;
  static constexpr double kThinnest = 0.1;  // symbols

  const ClassTable& classes_;
  double symbol_m_;
  const LiveConfig& live_;
  visualization_msgs::Marker marker_;
  visualization_msgs::MarkerArray array_;
  std::map<std::string, visualization_msgs::Marker> dots_;  ///< by class
  const std_msgs::ColorRGBA undecided_color_ = [] {
    std_msgs::ColorRGBA color;
    color.r = color.g = color.a = 1.0F;
    color.b = 0.2F;
    return color;
  }();
};

}  // namespace

double symbolSize(double range_factor, const SemanticMap& map) {
  Eigen::AlignedBox2d box;
  for (const Landmark& landmark : map.landmarks) box.extend(Eigen::Vector2d(landmark.position.x, landmark.position.y));
  return box.isEmpty() ? range_factor : std::max(range_factor, box.sizes().maxCoeff() / kSymbolsAcross);
}

visualization_msgs::MarkerArray toObjectMarkers(const Frame& frame, const Pose& T_map_odom, const ClassTable& classes,
                                                double symbol_m, const std::string& map_frame) {
  visualization_msgs::MarkerArray array;
  visualization_msgs::Marker marker;
  marker.header.frame_id = map_frame;
  marker.header.stamp = toRosTime(frame.stamp);
  marker.action = visualization_msgs::Marker::DELETEALL;
  array.markers.push_back(marker);
  marker.action = visualization_msgs::Marker::ADD;
  const Pose T_map_base = T_map_odom * frame.T_odom_base;
  marker.ns = "base";  // classes have names like "vehicle"
  marker.type = visualization_msgs::Marker::ARROW;
  marker.pose = toMessage(T_map_base);
  marker.scale.x = 8.0 * symbol_m;
  marker.scale.y = marker.scale.z = 2.0 * symbol_m;
  marker.color = vehicleColor();
  array.markers.push_back(marker);
  marker.type = visualization_msgs::Marker::CUBE;
  for (const Detection& detection : frame.detections) {
    const ClassInfo& info = classes[detection.class_index];
    marker.ns = info.name;
    marker.id = detection.row;
    marker.pose = toMessage(Pose{T_map_base.rotation, T_map_base * detection.position_m});
    const Eigen::Vector3d size = displaySize(detection, info, symbol_m);
    marker.scale.x = size.x();
    marker.scale.y = size.y();
    marker.scale.z = size.z();
    marker.color = toColor(info);
    array.markers.push_back(marker);
  }
  return array;
}

visualization_msgs::MarkerArray toLandmarkMarkers(const SemanticMap& map, const ClassTable& classes, double symbol_m,
                                                  const LiveConfig& live) {
  LandmarkDrawing drawing(map, classes, symbol_m, live);
  for (const Landmark& landmark : map.landmarks) {
    if (landmark.existence_prob >= live.landmark_min_existence_prob) drawing.add(landmark);
  }
  return drawing.take();
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
