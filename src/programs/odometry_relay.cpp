#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/odometry_axes.h"

#include "program.h"

namespace {

using namespace semantic_mht_slam;

constexpr char kHelp[] =
    "Turns the odometry of other packages into what slam_node takes: REP-103 axes, its frame names, tf.\n"
    "  rosrun semantic_mht_slam odometry_relay odometry_in:=/laser_odom_to_init _axes:=loam\n"
    "  rosrun semantic_mht_slam odometry_relay pose_in:=/orb_slam2_stereo/pose _axes:=ros\n"
    "in:  odometry_in (nav_msgs/Odometry) or pose_in (geometry_msgs/PoseStamped)\n"
    "out: odometry (nav_msgs/Odometry), tf odom_frame -> base_frame\n"
    "~axes        ros (x forward, y left, z up), loam (x left, y up, z forward), optical (x right, y down, z forward)\n"
    "~odom_frame  default odom\n"
    "~base_frame  default base_link\n"
    "~publish_tf  default true; false if somebody else publishes it\n";

class OdometryRelay {
 public:
  OdometryRelay() {
    const ros::NodeHandle parameters("~");
    axes_ = odometryAxesOf(parameters.param<std::string>("axes", "ros"));
    odom_frame_ = parameters.param<std::string>("odom_frame", "odom");
    base_frame_ = parameters.param<std::string>("base_frame", "base_link");
    publishes_tf_ = parameters.param("publish_tf", true);
    publisher_ = handle_.advertise<nav_msgs::Odometry>("odometry", 1000);
    odometry_subscriber_ = handle_.subscribe<nav_msgs::Odometry>(
        "odometry_in", 1000, [this](const nav_msgs::OdometryConstPtr& m) { relay(m->header.stamp, m->pose.pose); });
    pose_subscriber_ = handle_.subscribe<geometry_msgs::PoseStamped>(
        "pose_in", 1000, [this](const geometry_msgs::PoseStampedConstPtr& m) { relay(m->header.stamp, m->pose); });
  }

 private:
  void relay(const ros::Time& stamp, const geometry_msgs::Pose& pose) {
    const StampedPose T_odom_base{toStamp(stamp), toRosAxes(fromMessage(pose), axes_)};
    publisher_.publish(toOdometry(T_odom_base, odom_frame_, base_frame_));
    if (publishes_tf_) broadcaster_.sendTransform(toTransform(T_odom_base, odom_frame_, base_frame_));
  }

  ros::NodeHandle handle_;
  OdometryAxes axes_ = OdometryAxes::kRos;
  std::string odom_frame_;
  std::string base_frame_;
  bool publishes_tf_ = true;
  ros::Publisher publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Subscriber odometry_subscriber_;
  ros::Subscriber pose_subscriber_;
};

int run(int argc, char** argv) {
  if (printedHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "odometry_relay");
  const OdometryRelay relay;
  ros::spin();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("odometry_relay", [&] { return run(argc, argv); });
}
