#include "semantic_mht_slam/bags/conversions.h"

#include <cmath>

namespace semantic_mht_slam {
namespace {

Pose fromParts(double x, double y, double z, const geometry_msgs::Quaternion& q) {
  const Pose pose{Eigen::Quaterniond(q.w, q.x, q.y, q.z), {x, y, z}};
  const double norm = pose.rotation.norm();
  return std::isfinite(norm) && norm > 1e-9 ? normalized(pose) : pose;
}

Detection fromObject(const SemanticObject& object, ClassIndex class_index, const Pose& T_base_sensor) {
  Detection detection;
  detection.class_index = class_index;
  const Eigen::Vector3d position_m(object.position.x, object.position.y, object.position.z);
  // What a sensor puts where it has no range of something is not to look like an object where the sensor is.
  detection.position_m = position_m.isZero(0.0) ? position_m : T_base_sensor * position_m;
  if (object.score != -1.0) detection.score = object.score;
  const Eigen::Matrix3d cov = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(object.covariance.data());
  if (!cov.isZero(0.0)) {
    const Eigen::Matrix3d R = T_base_sensor.rotation.toRotationMatrix();
    const bool is_rotated = !R.isIdentity(0.0);
    detection.cov_m2 = is_rotated ? Eigen::Matrix3d(R * cov * R.transpose()) : cov;
  }
  const Eigen::Vector3d size(object.size.x, object.size.y, object.size.z);
  if (!size.isZero(0.0)) detection.size_m = size;
  if (object.points > 0) detection.points = static_cast<int>(object.points);
  detection.is_moving = object.is_moving != 0;
  return detection;
}

SemanticObject toObject(const Detection& detection, const ClassTable& classes) {
  SemanticObject object;
  object.class_id = static_cast<std::uint16_t>(classes[detection.class_index].id);
  object.position.x = detection.position_m.x();
  object.position.y = detection.position_m.y();
  object.position.z = detection.position_m.z();
  object.score = detection.score.value_or(-1.0);
  const Eigen::Matrix3d cov = detection.cov_m2.value_or(Eigen::Matrix3d::Zero());
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(object.covariance.data()) = cov;
  const Eigen::Vector3d size = detection.size_m.value_or(Eigen::Vector3d::Zero());
  object.size.x = size.x();
  object.size.y = size.y();
  object.size.z = size.z();
  object.points = static_cast<std::uint32_t>(detection.points.value_or(0));
  object.is_moving = detection.is_moving ? 1 : 0;
  return object;
}

template <class Covariance>
void fillGaussian(const Gaussian3& gaussian, geometry_msgs::Point& mean, Covariance& covariance) {
  mean.x = gaussian.mean_m.x();
  mean.y = gaussian.mean_m.y();
  mean.z = gaussian.mean_m.z();
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(covariance.data()) = gaussian.cov_m2;
}

}  // namespace

ros::Time toRosTime(Stamp stamp) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp));
}

Stamp toStamp(const ros::Time& time) {
  return static_cast<Stamp>(time.toNSec());
}

geometry_msgs::Pose toMessage(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.translation_m.x();
  message.position.y = pose.translation_m.y();
  message.position.z = pose.translation_m.z();
  message.orientation.x = pose.rotation.x();
  message.orientation.y = pose.rotation.y();
  message.orientation.z = pose.rotation.z();
  message.orientation.w = pose.rotation.w();
  return message;
}

geometry_msgs::PoseWithCovariance toMessage(const Pose& pose, const FixedAxesCov& cov) {
  geometry_msgs::PoseWithCovariance message;
  message.pose = toMessage(pose);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.covariance.data()) = cov;
  return message;
}

Pose fromMessage(const geometry_msgs::Pose& message) {
  return fromParts(message.position.x, message.position.y, message.position.z, message.orientation);
}

Pose fromMessage(const geometry_msgs::Transform& message) {
  return fromParts(message.translation.x, message.translation.y, message.translation.z, message.rotation);
}

geometry_msgs::TransformStamped toTransform(const StampedPose& T_parent_child, const std::string& parent,
                                            const std::string& child) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = toRosTime(T_parent_child.stamp);
  message.header.frame_id = parent;
  message.child_frame_id = child;
  const geometry_msgs::Pose pose = toMessage(T_parent_child.T_world_base);
  message.transform.translation.x = pose.position.x;
  message.transform.translation.y = pose.position.y;
  message.transform.translation.z = pose.position.z;
  message.transform.rotation = pose.orientation;
  return message;
}

nav_msgs::Odometry toOdometry(const StampedPose& T_odom_base, const std::string& odom_frame,
                              const std::string& base_frame) {
  nav_msgs::Odometry message;
  message.header.stamp = toRosTime(T_odom_base.stamp);
  message.header.frame_id = odom_frame;
  message.child_frame_id = base_frame;
  message.pose.pose = toMessage(T_odom_base.T_world_base);
  return message;
}

nav_msgs::Path toPath(const std::vector<StampedPose>& T_map_base, const std::string& map_frame) {
  nav_msgs::Path path;
  path.header.frame_id = map_frame;
  if (!T_map_base.empty()) path.header.stamp = toRosTime(T_map_base.back().stamp);
  path.poses.resize(T_map_base.size());
  for (std::size_t i = 0; i < T_map_base.size(); ++i) {
    path.poses[i].header.stamp = toRosTime(T_map_base[i].stamp);
    path.poses[i].header.frame_id = map_frame;
    path.poses[i].pose = toMessage(T_map_base[i].T_world_base);
  }
  return path;
}

SemanticObjectArray toMessage(Stamp stamp, const std::string& sensor_frame, const Detections& detections,
                              const ClassTable& classes) {
  SemanticObjectArray message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = sensor_frame;
  for (const Detection& detection : detections) message.objects.push_back(toObject(detection, classes));
  return message;
}

Detections fromMessage(const SemanticObjectArray& message, const ClassTable& classes, const Pose& T_base_sensor,
                       std::size_t& unknown_classes) {
  Detections detections;
  detections.reserve(message.objects.size());
  for (std::size_t row = 0; row < message.objects.size(); ++row) {
    const SemanticObject& object = message.objects[row];
    const std::optional<ClassIndex> class_index = classes.findId(object.class_id);
    if (!class_index) {
      ++unknown_classes;
      continue;
    }
    detections.push_back(fromObject(object, *class_index, T_base_sensor));
    detections.back().row = static_cast<int>(row);
  }
  return detections;
}

Landmark toMessage(const MixtureLandmark& landmark, const ClassTable& classes) {
  Landmark message;
  message.id = landmark.id;
  message.class_id = static_cast<std::uint16_t>(classes[landmark.mostLikelyClass()].id);
  message.class_probs.assign(landmark.class_probs.begin(), landmark.class_probs.end());
  fillGaussian(landmark.position, message.position, message.covariance);
  for (const MixtureComponent& component : landmark.components) {
    message.components.emplace_back();
    message.components.back().weight = component.weight;
    fillGaussian(component.position, message.components.back().mean, message.components.back().covariance);
  }
  message.existence_prob = landmark.existence_prob;
  message.movable = !classes[landmark.mostLikelyClass()].is_static;
  message.seen_standing = landmark.seen_standing_s;
  message.observations = static_cast<std::uint32_t>(landmark.observations);
  message.undecided = landmark.isUndecided();
  message.first_submap = static_cast<std::uint32_t>(landmark.first_submap.index());
  message.last_submap = static_cast<std::uint32_t>(landmark.last_submap.index());
  message.merged_ids = landmark.merged_ids;
  message.size.x = landmark.size.mean_m.x();
  message.size.y = landmark.size.mean_m.y();
  message.size.z = landmark.size.mean_m.z();
  message.locked = landmark.is_locked;
  return message;
}

SemanticMap toMessage(Stamp stamp, const std::string& map_frame, const ClassTable& classes,
                      const std::vector<MixtureLandmark>& landmarks, std::size_t submaps) {
  SemanticMap map;
  map.header.stamp = toRosTime(stamp);
  map.header.frame_id = map_frame;
  map.submaps = static_cast<std::uint32_t>(submaps);
  for (const ClassInfo& info : classes.all()) {
    map.classes.emplace_back();
    map.classes.back().id = static_cast<std::uint16_t>(info.id);
    map.classes.back().name = info.name;
    map.classes.back().is_static = info.is_static;
    map.classes.back().color = info.color;
  }
  for (const MixtureLandmark& landmark : landmarks) map.landmarks.push_back(toMessage(landmark, classes));
  return map;
}

HypothesisTree toMessage(const Frame& frame, const std::string& map_frame, SubmapId submap,
                         const std::vector<MapHypothesis>& leaves) {
  HypothesisTree message;
  message.header.stamp = toRosTime(frame.stamp);
  message.header.frame_id = map_frame;
  message.submap = static_cast<std::uint32_t>(submap.index());
  double squares = 0.0;
  for (const MapHypothesis& leaf : leaves) {
    message.hypotheses.emplace_back();
    semantic_mht_slam::Hypothesis& hypothesis = message.hypotheses.back();
    hypothesis.id = leaf.id;
    hypothesis.parent_id = leaf.parent_id;
    hypothesis.weight = std::exp(leaf.log_weight);
    hypothesis.log_weight = leaf.log_weight;
    hypothesis.age = static_cast<std::uint32_t>(frame.index - leaf.born_frame);
    hypothesis.landmarks = static_cast<std::uint32_t>(leaf.landmarks.size());
    squares += hypothesis.weight * hypothesis.weight;
  }
  message.effective_sample_size = squares > 0.0 ? 1.0 / squares : 0.0;
  return message;
}

}  // namespace semantic_mht_slam
