#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/SemanticMap.h>
#include <semantic_mht_slam/SetMode.h>

#include "semantic_mht_slam/ros/service_call.h"

#include "support/running_node.h"
#include "support/spinner.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

TEST(NodeFaultsTest, QueueThatIsFullDropsAndSaysSoAndThePoseGoesOn) {
  RunningNode node("full", {"_node/queue_size:=1"});
  ASSERT_TRUE(node.isReady());
  for (int i = 0; i < 3000; ++i) {
    node.sendOdometry(0.01 * i);
    node.sendObjects(0.01 * i);
  }
  EXPECT_TRUE(waitFor([&] {
    return std::stoul("0" + node.value("queue", "dropped, odometry")) > 0 &&
           std::stoul("0" + node.value("queue", "dropped, objects")) > 0;
  }));
  EXPECT_EQ(node.status("queue").level, diagnostic_msgs::DiagnosticStatus::WARN);
  ros::WallDuration(1.0).sleep();
  node.sendOdometry(31.0);
  EXPECT_TRUE(node.comesToSay("odometry", "newest stamp (s)", "1031.000"));
  EXPECT_TRUE(waitFor([&] { return node.value("queue", "waiting") == "0"; }));
}

TEST(NodeFaultsTest, MoreObjectsThanTheEstimatorCanTakeDelayNoPoseAndTheOldestAreDropped) {
  RunningNode node("overload", {"_node/max_delay:=1.0"});
  std::mutex mutex;
  std::map<std::uint64_t, double> came_s;  // wall time of each pose, by stamp
  const auto subscriber = node.handle().subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "pose", 1000,
      boost::function<void(const geometry_msgs::PoseWithCovarianceStampedConstPtr&)>(
          [&](const geometry_msgs::PoseWithCovarianceStampedConstPtr& pose) {
            const std::lock_guard<std::mutex> lock(mutex);
            came_s.emplace(pose->header.stamp.toNSec(), ros::WallTime::now().toSec());
          }));
  ASSERT_TRUE(node.isReady());
  ASSERT_TRUE(waitFor([&] { return subscriber.getNumPublishers() > 0; }));
  std::map<std::uint64_t, double> sent_s;
  ros::WallRate rate(50.0);
  for (int i = 0; i < 400; ++i) {
    sent_s[toRosTime(stampFromSeconds(RunningNode::kBegin_s + 0.02 * i)).toNSec()] = ros::WallTime::now().toSec();
    node.sendOdometry(0.02 * i);
    if (i % 5 == 0) node.sendObjects(0.02 * i, RunningNode::kPole, 2000);
    rate.sleep();
  }
  EXPECT_GT(std::stoul("0" + node.value("queue", "dropped, objects")), 0U) << "the load was none";
  EXPECT_EQ(node.value("queue", "dropped, odometry"), "0");
  ros::WallDuration(0.5).sleep();
  const std::lock_guard<std::mutex> lock(mutex);
  std::vector<double> late_s;  // of the newest pose at each moment: one that was overtaken is not missed
  for (const auto& [stamp, time_s] : sent_s) {
    const auto pose = std::find_if(came_s.lower_bound(stamp), came_s.end(), [](const auto&) { return true; });
    late_s.push_back(pose == came_s.end() ? 1e3 : pose->second - time_s);
  }
  std::sort(late_s.begin(), late_s.end());
  EXPECT_LT(late_s[late_s.size() / 2], 0.2);
  EXPECT_LT(late_s.back(), 1.0) << "on a busy machine; alone 0.2 s";
}

TEST(NodeFaultsTest, WhatIsLostBeforeItComesIsCountedByItsNumbers) {
  RunningNode node("lossy", {"odometry:=numbered"});
  ros::AdvertiseOptions options;
  options.init<nav_msgs::Odometry>("numbered", 100);
  options.has_header = false;  // the numbers stay those of the test
  ros::Publisher publisher = node.handle().advertise(options);
  ASSERT_TRUE(waitFor([&] { return publisher.getNumSubscribers() > 0 && !node.value("queue", "capacity").empty(); }));
  for (std::uint32_t number = 1; number <= 50; ++number) {
    if (number > 30 && number <= 37) continue;
    const Pose pose{Eigen::Quaterniond::Identity(), {0.01 * number, 0.0, 0.0}};
    nav_msgs::Odometry message =
        toOdometry({stampFromSeconds(RunningNode::kBegin_s + 0.01 * number), pose}, "odom", "base_link");
    message.header.seq = number;
    publisher.publish(message);
    ros::WallDuration(0.002).sleep();
  }
  EXPECT_TRUE(node.comesToSay("odometry", "messages", "43"));
  EXPECT_TRUE(node.comesToSay("odometry", "lost before they came", "7"));
}

TEST(NodeFaultsTest, DetectionsLateByTwoSecondsAreAllUsed) {
  RunningNode node("late");
  ASSERT_TRUE(node.isReady());
  for (int i = 0; i < 100; ++i) {
    node.sendOdometry(0.1 * i);
    if (i > 20) node.sendObjects(0.1 * (i - 20) - 0.05);
    ros::WallDuration(0.002).sleep();  // so that odometry and objects do arrive in this order
  }
  EXPECT_TRUE(node.comesToSay("objects", "frames used", "79"));
  EXPECT_EQ(node.value("objects", "dropped, before the odometry"), "0");
  EXPECT_NEAR(std::stod("0" + node.value("objects", "delay (s)")), 2.05, 0.3);
}

TEST(NodeFaultsTest, DetectionsMissingForThirtySecondsStopNothing) {
  RunningNode node("missing");
  ASSERT_TRUE(node.isReady());
  const auto isMissing = [](int i) { return i > 100 && i <= 400; };
  for (int i = 0; i < 500; ++i) {
    node.sendOdometry(0.1 * i);
    if (!isMissing(i)) node.sendObjects(0.1 * i);
    ros::WallDuration(0.002).sleep();
  }
  EXPECT_TRUE(node.comesToSay("odometry", "used", "500"));
  EXPECT_TRUE(node.comesToSay("objects", "frames used", "200"));
}

TEST(NodeFaultsTest, DetectionsBeforeAnyOdometryWaitForIt) {
  RunningNode node("before");
  ASSERT_TRUE(node.isReady());
  for (int i = 1; i <= 20; ++i) node.sendObjects(0.1 * i);
  EXPECT_TRUE(node.comesToReport("odometry", "no odometry on /before/odometry"));
  for (int i = 0; i <= 30; ++i) node.sendOdometry(0.1 * i);
  EXPECT_TRUE(node.comesToSay("objects", "frames used", "20"));
}

TEST(NodeFaultsTest, WrongFramesAndUnmappedClassesAreNamedInDiagnostics) {
  RunningNode node("wrong", {"_node/tf_timeout:=0.2"});
  ASSERT_TRUE(node.isReady());
  for (int i = 0; i < 60; ++i) {
    node.sendOdometry(0.1 * i);
    node.sendOdometry(0.1 * i, "camera_init");
    node.sendObjects(0.1 * i, 99);
    ros::WallDuration(0.01).sleep();
  }
  EXPECT_TRUE(node.comesToReport("odometry", "'camera_init' to 'base_link', expected is 'odom' to 'base_link'"));
  EXPECT_TRUE(node.comesToReport("objects", "class id 99 on /wrong/objects not in the class table"));
  EXPECT_EQ(node.value("objects", "objects of unknown class id 99"), "180");
  node.sendObjects(6.0, RunningNode::kPole, 1, "nowhere");
  ros::WallDuration(0.5).sleep();
  node.sendOdometry(6.1);
  EXPECT_TRUE(node.comesToReport("objects", "no transform from 'nowhere' to 'base_link'"));
}

TEST(NodeFaultsTest, SlashBeforeAFrameIsNoFault) {
  RunningNode node("slash");
  ASSERT_TRUE(node.isReady());
  node.sendOdometry(0.0, "/odom");
  node.sendObjects(0.0, RunningNode::kPole, 1, "/base_link");
  EXPECT_TRUE(node.comesToSay("objects", "frames used", "1"));
}

TEST(NodeFaultsTest, ClockThatFallsBackBeginsANewMap) {
  RunningNode node("loop");
  ASSERT_TRUE(node.isReady());
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 100; ++i) {
      node.sendOdometry(0.1 * i);
      node.sendObjects(0.1 * i);
      ros::WallDuration(0.002).sleep();
    }
  }
  EXPECT_TRUE(node.comesToSay("estimator", "maps begun", "3"));
  EXPECT_TRUE(node.comesToSay("odometry", "used", "100"));
}

TEST(NodeFaultsTest, InterruptEndsTheNodeWithinTwoSecondsUnderLoad) {
  RunningNode node("interrupt");
  ASSERT_TRUE(node.isReady());
  for (int i = 0; i < 2000; ++i) {
    node.sendOdometry(0.1 * i);
    node.sendObjects(0.1 * i, RunningNode::kPole, 30);
  }
  const double seconds = node.process().stop(SIGINT, 10.0);
  EXPECT_GE(seconds, 0.0);
  EXPECT_LT(seconds, 2.0);
  EXPECT_EQ(node.process().exitCode(), 0);
}

TEST(NodeServicesTest, FinishSubmapAndResetAnswerAndDoWhatTheySay) {
  RunningNode node("services");
  SemanticMap map;
  const auto subscriber = node.handle().subscribe<SemanticMap>(
      "map", 10, boost::function<void(const SemanticMapConstPtr&)>([&](const SemanticMapConstPtr& m) { map = *m; }));
  ASSERT_TRUE(node.isReady());
  EXPECT_FALSE(node.call<std_srvs::Trigger>("finish_submap").success) << "nothing was seen yet";
  for (int i = 0; i < 30; ++i) {
    node.sendOdometry(0.01 * i);
    node.sendObjects(0.01 * i);
    ros::WallDuration(0.002).sleep();
  }
  ASSERT_TRUE(node.comesToSay("objects", "frames used", "30"));
  EXPECT_EQ(node.value("estimator", "submaps"), "0");
  EXPECT_TRUE(node.call<std_srvs::Trigger>("finish_submap").success);
  EXPECT_TRUE(waitFor([&] { return map.submaps == 1U; }));
  EXPECT_TRUE(node.comesToSay("estimator", "submaps", "1"));
  EXPECT_FALSE(node.call<std_srvs::Trigger>("finish_submap").success) << "nothing was seen since";

  EXPECT_TRUE(node.call<std_srvs::Trigger>("reset").success);
  EXPECT_TRUE(waitFor([&] { return map.submaps == 0U; })) << "the latched map is empty again";
  EXPECT_TRUE(node.comesToSay("odometry", "used", "0"));
  node.sendOdometry(0.0);
  EXPECT_TRUE(node.comesToSay("odometry", "used", "1")) << "after a reset older stamps are welcome";
}

TEST(NodeServicesTest, LiveParametersChangeTheMarkersAtOnceAndWrongOnesStayAsTheyWere) {
  RunningNode node("live", {"_node/live/correction:=limited"});
  std::atomic<std::size_t> labels{0};
  const auto subscriber = node.handle().subscribe<visualization_msgs::MarkerArray>(
      "markers/landmarks", 10,
      boost::function<void(const visualization_msgs::MarkerArrayConstPtr&)>(
          [&](const visualization_msgs::MarkerArrayConstPtr& message) {
            labels = static_cast<std::size_t>(std::count_if(message->markers.begin(), message->markers.end(),
                                                            [](const auto& marker) { return marker.ns == "labels"; }));
          }));
  ASSERT_TRUE(node.isReady());
  for (int i = 0; i < 30; ++i) {
    node.sendOdometry(0.0001 * i);
    node.sendObjects(0.0001 * i);
    ros::WallDuration(0.002).sleep();
  }
  ASSERT_TRUE(node.comesToSay("objects", "frames used", "30"));
  ASSERT_TRUE(node.call<std_srvs::Trigger>("finish_submap").success);
  ASSERT_TRUE(node.comesToSay("estimator", "landmarks", "3"));
  EXPECT_EQ(labels, 0U);

  dynamic_reconfigure::Reconfigure change;
  change.request.config.bools.resize(1);
  change.request.config.bools[0].name = "landmark_labels";
  change.request.config.bools[0].value = 1;
  change.request.config.strs.resize(1);
  change.request.config.strs[0].name = "correction";
  change.request.config.strs[0].value = "sometimes";
  ASSERT_TRUE(callService(node.fullName() + "/node/live/set_parameters", change));
  EXPECT_TRUE(waitFor([&] { return labels == 3U; }));
  ASSERT_EQ(change.response.config.strs.size(), 1U);
  EXPECT_EQ(change.response.config.strs[0].value, "limited") << "there is no policy 'sometimes'";
}

TEST(NodeServicesTest, SetModeRefusesWhatThereIsNot) {
  RunningNode node("mode");
  ASSERT_TRUE(node.isReady());
  SetMode::Request request;
  request.mode = SetMode::Request::MAPPING;
  EXPECT_TRUE(node.call<SetMode>("set_mode", request).success);
  request.mode = SetMode::Request::LOCALIZATION;
  EXPECT_FALSE(node.call<SetMode>("set_mode", request).success) << "without a loaded map";
  request.mode = 7;
  EXPECT_FALSE(node.call<SetMode>("set_mode", request).success);
}

}  // namespace
}  // namespace semantic_mht_slam
