#include <boost/make_shared.hpp>
#include <rosbag/bag.h>
#include <std_msgs/Time.h>
#include <tf2_msgs/TFMessage.h>

#include "semantic_mht_slam/bags/atomic_bag.h"
#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/ros_time.h"

namespace semantic_mht_slam {
namespace {

/// Tells players to latch the topic.
boost::shared_ptr<ros::M_string> latchedHeader() {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["latching"] = "1";
  (*header)["callerid"] = "/semantic_mht_slam";
  return header;
}

template <class Message>
void writeLatched(rosbag::Bag& bag, const std::string& topic, Stamp stamp, const Message& message) {
  const boost::shared_ptr<ros::M_string> header = latchedHeader();
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::datatype(message);
  (*header)["md5sum"] = ros::message_traits::md5sum(message);
  (*header)["message_definition"] = ros::message_traits::definition(message);
  bag.write(topic, toRosTime(stamp), message, header);
}

std::vector<StampedPose> shifted(std::vector<StampedPose> trajectory, Stamp time_origin) {
  for (StampedPose& pose : trajectory) pose.stamp += time_origin;
  return trajectory;
}

void writeHead(rosbag::Bag& bag, const Recording& recording, const NodeConfig& frames, const BagLayout& layout,
               Stamp begin, Stamp time_origin) {
  tf2_msgs::TFMessage static_transforms;
  static_transforms.transforms.push_back(
      toTransform({begin, Pose::identity()}, frames.base_frame, layout.sensor_frame));
  if (recording.T_base_cam0) {
    static_transforms.transforms.push_back(
        toTransform({begin, *recording.T_base_cam0}, frames.base_frame, layout.camera_frame));
  }
  writeLatched(bag, "/tf_static", begin, static_transforms);
  std_msgs::Time origin;
  origin.data = toRosTime(time_origin);
  writeLatched(bag, layout.time_origin_topic, begin, origin);
  if (!recording.ground_truth.empty()) {
    writeLatched(bag, layout.ground_truth_topic, begin,
                 toPath(shifted(recording.ground_truth, time_origin), frames.map_frame));
  }
}

}  // namespace

void writeBag(const std::string& path, const Recording& recording, const ClassTable& classes, const NodeConfig& frames,
              const BagLayout& layout, Stamp time_origin) {
  if (recording.odometry.empty()) throw InputError("cannot write '" + path + "': no odometry");
  if (recording.odometry.back().stamp > kLastStamp - time_origin) {
    throw InputError("cannot write '" + path + "': stamps go beyond the end of ROS time, 2106");
  }
  writeBagAtomically(path, [&](rosbag::Bag& bag) {
    writeHead(bag, recording, frames, layout, recording.odometry.front().stamp + time_origin, time_origin);
    auto frame = recording.detector_frames.begin();
    for (StampedPose odometry : recording.odometry) {
      odometry.stamp += time_origin;
      const ros::Time time = toRosTime(odometry.stamp);
      tf2_msgs::TFMessage transform;
      transform.transforms.push_back(toTransform(odometry, frames.odom_frame, frames.base_frame));
      bag.write("/tf", time, transform);
      bag.write(layout.odometry_topic, time, toOdometry(odometry, frames.odom_frame, frames.base_frame));
      for (; frame != recording.detector_frames.end() && frame->stamp + time_origin <= odometry.stamp; ++frame) {
        const SemanticObjectArray objects =
            toMessage(frame->stamp + time_origin, layout.sensor_frame, frame->detections, classes);
        bag.write(layout.objects_topic, objects.header.stamp, objects);
      }
    }
  });
}

}  // namespace semantic_mht_slam
