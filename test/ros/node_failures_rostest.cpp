// What must not end the node: numbers that nobody should send, and failures that nobody foresaw.
#include <atomic>
#include <cstdlib>
#include <limits>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <semantic_mht_slam/SetMode.h>

#include "semantic_mht_slam/ros/service_call.h"

#include "support/running_node.h"
#include "support/spinner.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// Counts the poses that a node publishes.
class PoseCounter {
 public:
  explicit PoseCounter(RunningNode& node)
      : subscriber_(node.handle().subscribe<geometry_msgs::PoseWithCovarianceStamped>(
            "pose", 1000,
            boost::function<void(const geometry_msgs::PoseWithCovarianceStampedConstPtr&)>(
                [this](const geometry_msgs::PoseWithCovarianceStampedConstPtr&) { ++count_; }))) {}

  bool comesTo(std::size_t count) const {
    return waitFor([&] { return count_ >= count; });
  }
  bool isConnected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  std::atomic<std::size_t> count_{0};
  ros::Subscriber subscriber_;
};

/// Frames 0.01 s apart, with objects around the base.
void feed(RunningNode& node, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    node.sendOdometry(0.01 * i);
    node.sendObjects(0.01 * i);
    ros::WallDuration(0.002).sleep();
  }
}

geometry_msgs::PoseWithCovarianceStamped initialPose(double variance_m2, double x_m = 0.0) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.frame_id = "map";
  message.pose.pose.position.x = x_m;
  message.pose.pose.orientation.w = 1.0;
  message.pose.covariance[0] = variance_m2;
  return message;
}

TEST(NodeFailuresTest, NumbersThatNobodyShouldSendAreRefusedAndNamed) {
  RunningNode node("hostile");
  PoseCounter poses(node);
  ros::Publisher initial_pose = node.handle().advertise<geometry_msgs::PoseWithCovarianceStamped>("initialpose", 100);
  ros::Publisher odometry = node.handle().advertise<nav_msgs::Odometry>("odometry", 100);
  ros::Publisher objects = node.handle().advertise<SemanticObjectArray>("objects", 100);
  ASSERT_TRUE(node.isReady());
  ASSERT_TRUE(waitFor([&] {
    return initial_pose.getNumSubscribers() > 0 && odometry.getNumSubscribers() > 0 &&
           objects.getNumSubscribers() > 0 && poses.isConnected();
  }));
  feed(node, 0, 40);
  ASSERT_TRUE(node.comesToSay("objects", "frames used", "40"));
  std_srvs::Trigger finish;
  ASSERT_TRUE(callService("/hostile/finish_submap", finish) && finish.response.success);
  SetMode mode;
  mode.request.mode = SetMode::Request::LOCALIZATION;
  ASSERT_TRUE(callService("/hostile/set_mode", mode) && mode.response.success);

  initial_pose.publish(initialPose(kInfinity));
  EXPECT_TRUE(node.comesToReport("estimator", "initialpose is refused: its covariance is not finite"));
  initial_pose.publish(initialPose(kNotANumber));
  EXPECT_TRUE(node.comesToSay("estimator", "initial poses refused", "2"));
  initial_pose.publish(initialPose(1.0, 1e308));
  EXPECT_TRUE(node.comesToSay("estimator", "initial poses refused", "3"));
  initial_pose.publish(initialPose(1.0, kNotANumber));
  EXPECT_TRUE(node.comesToSay("estimator", "initial poses refused", "4"));
  initial_pose.publish(initialPose(1e300));

  for (int i = 0; i < 2; ++i) {
    nav_msgs::Odometry last_second;
    last_second.header.stamp = ros::Time(4294967295U, static_cast<std::uint32_t>(i));
    last_second.header.frame_id = "odom";
    last_second.child_frame_id = "base_link";
    last_second.pose.pose.orientation.w = 1.0;
    odometry.publish(last_second);
  }
  EXPECT_TRUE(node.comesToSay("odometry", "dropped, bad stamp", "2"));
  SemanticObjectArray far;
  far.header.frame_id = "base_link";
  far.header.stamp = toRosTime(stampFromSeconds(RunningNode::kBegin_s + 0.395));
  far.objects.resize(1);
  far.objects[0].class_id = RunningNode::kPole;
  far.objects[0].position.x = 1e308;
  far.objects[0].score = -1.0;
  objects.publish(far);
  ros::WallDuration(0.2).sleep();
  for (int i = 40; i < 44; ++i) {
    const Pose on_the_line{Eigen::Quaterniond::Identity(), {0.1 * i, 0.0, 0.0}};
    nav_msgs::Odometry uncertain =
        toOdometry({stampFromSeconds(RunningNode::kBegin_s + 0.01 * i), on_the_line}, "odom", "base_link");
    const double values[] = {kInfinity, kNotANumber, -1.0, 1e308};
    uncertain.pose.covariance.fill(values[i - 40]);
    uncertain.twist.covariance.fill(values[i - 40]);
    odometry.publish(uncertain);
  }
  feed(node, 44, 80);
  EXPECT_TRUE(poses.comesTo(80)) << "every odometry sample but the two without a time has its pose";
  EXPECT_EQ(node.value("estimator", "unexpected failures of the input"), "0") << "refused at the door, not caught";
  EXPECT_EQ(node.value("estimator", "unexpected failures of services and timers"), "0");
}

TEST(NodeFailuresTest, AFailureDropsItsMessageAndThreeInARowLeaveTheOdometryAtWork) {
  ::setenv("LD_PRELOAD", (std::string(SMHT_PROGRAM_DIR) + "/../libfailing_conversion.so").c_str(), 1);
  RunningNode node("failing");
  ::unsetenv("LD_PRELOAD");
  PoseCounter poses(node);
  ASSERT_TRUE(node.isReady());
  ASSERT_TRUE(waitFor([&] { return poses.isConnected(); }));
  feed(node, 0, 20);
  ASSERT_TRUE(node.comesToSay("objects", "frames used", "20"));
  node.sendObjects(0.195, RunningNode::kPole, 13);
  EXPECT_TRUE(node.comesToReport("estimator", "an unexpected failure dropped a message: objects: made to fail"));
  feed(node, 20, 40);
  EXPECT_TRUE(node.comesToSay("objects", "frames used", "40")) << "one message was lost, no more";
  EXPECT_TRUE(poses.comesTo(40));

  for (int i = 0; i < 3; ++i) node.sendObjects(0.391 + 0.001 * i, RunningNode::kPole, 13);
  EXPECT_TRUE(node.comesToReport("estimator", "the estimator failed three times in a row and stands still"));
  feed(node, 40, 60);
  EXPECT_TRUE(poses.comesTo(60)) << "by odometry alone";
  EXPECT_TRUE(node.comesToSay("estimator", "objects dropped while it stands still", "20"));
  EXPECT_EQ(node.value("objects", "frames used"), "40");

  std_srvs::Trigger reset;
  ASSERT_TRUE(callService("/failing/reset", reset) && reset.response.success);
  feed(node, 60, 80);
  EXPECT_TRUE(node.comesToSay("objects", "frames used", "20")) << "of the new map";
  EXPECT_TRUE(poses.comesTo(80));
}

}  // namespace
}  // namespace semantic_mht_slam
