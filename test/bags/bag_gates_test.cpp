// A bag goes through the gates of the node: what they let pass, and what they refuse with its cause.
#include <functional>
#include <map>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/bags/conversions.h"

#include "support/expect_input_error.h"
#include "support/recordings.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

constexpr int kFrames = 60;
constexpr double kBegin_s = 1000.0;
const Eigen::Vector3d kObject_in_odom_m(20.0, 5.0, 1.0);

/// A bag of a straight drive, 1 m and 0.1 s a frame, past one object; tests change how it is told.
class BagGatesTest : public ::testing::Test {
 protected:
  static double timeAt(int i) { return kBegin_s + 0.1 * i; }
  static StampedPose odometryAt(int i) {
    return {stampFromSeconds(timeAt(i)), Pose{Eigen::Quaterniond::Identity(), {1.0 * i, 0.0, 0.0}}};
  }

  void addTransform(rosbag::Bag& bag, const std::string& topic, double time_s, const std::string& parent,
                    const std::string& child, const Pose& T_parent_child) const {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(toTransform({stampFromSeconds(time_s), T_parent_child}, parent, child));
    bag.write(topic, ros::Time(time_s), message);
  }

  /// Frame `i`: the object as the frame `objects_frame` at `T_odom_objects` sees it.
  void addFrame(rosbag::Bag& bag, int i, const Pose& T_odom_objects) const {
    nav_msgs::Odometry odometry = toOdometry(odometryAt(i), odom_frame_, base_frame_);
    if (change_odometry_) change_odometry_(i, odometry);
    bag.write(odometry_topic_, ros::Time(timeAt(i)), odometry);
    Detection detection;
    detection.position_m = T_odom_objects.inverse() * kObject_in_odom_m;
    SemanticObjectArray objects = toMessage(odometryAt(i).stamp, objects_frame_, {detection, detection}, classes_);
    objects.objects[1].position.y += 4.0;
    if (change_objects_) change_objects_(i, objects);
    bag.write(objects_topic_, ros::Time(timeAt(i)), objects);
  }

  /// All frames, with objects of a sensor at `T_base_sensor`.
  void addDrive(rosbag::Bag& bag, const Pose& T_base_sensor = Pose::identity()) const {
    for (int i = 0; i < kFrames; ++i) addFrame(bag, i, odometryAt(i).T_world_base * T_base_sensor);
  }

  Recording read() const { return readBag(path_, classes_, {}, layout_); }

  RunResult run() const {
    return runOffline(read(), SlamConfig{}, classes_, [](std::size_t, std::size_t) {});
  }

  /// Every detection is where the object is.
  static void expectInPlace(const Recording& recording) {
    for (const DetectorFrame& frame : recording.detector_frames) {
      const double x_m = 10.0 * (secondsFromStamp(frame.stamp) - kBegin_s);
      const Eigen::Vector3d expected_m = kObject_in_odom_m - Eigen::Vector3d(x_m, 0.0, 0.0);
      EXPECT_LT((frame.detections.at(0).position_m - expected_m).norm(), 1e-6) << secondsFromStamp(frame.stamp);
    }
  }

  const ClassTable classes_ = makeTwoClasses();
  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "drive.bag";
  BagLayout layout_;
  std::string odometry_topic_ = "/odometry";
  std::string objects_topic_ = "/objects";
  std::string odom_frame_ = "odom";
  std::string base_frame_ = "base_link";
  std::string objects_frame_ = "base_link";
  std::function<void(int, nav_msgs::Odometry&)> change_odometry_;
  std::function<void(int, SemanticObjectArray&)> change_objects_;
};

TEST_F(BagGatesTest, SlashesBeforeFramesAndOtherTopicsAreNoFault) {
  odom_frame_ = "/odom";
  base_frame_ = "/base_link";
  objects_frame_ = "/lidar";
  odometry_topic_ = "/robot/odom";
  objects_topic_ = "/robot/objects";
  const Pose T_base_lidar{expRotation({0.0, 0.0, 0.5}), {1.0, 0.0, 2.0}};
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addTransform(bag, "/tf_static", kBegin_s, "base_link", "lidar", T_base_lidar);
    addDrive(bag, T_base_lidar);
  }
  expectInputError([&] { read(); }, {"no messages on /odometry", "/robot/odom (nav_msgs/Odometry)", "/robot/objects"});
  layout_.odometry_topic = "/robot/odom";
  layout_.objects_topic = "robot/objects";
  const Recording recording = read();
  EXPECT_EQ(recording.detector_frames.size(), kFrames);
  EXPECT_TRUE(droppedInput({}, recording.refused, recording.names).empty());
  expectInPlace(recording);
}

TEST_F(BagGatesTest, ASensorOnTfIsTakenWhenItComes) {
  objects_frame_ = "lidar";
  const Pose T_base_lidar{expRotation({0.0, 0.0, 0.5}), {1.0, 0.0, 2.0}};
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addTransform(bag, "/tf", kBegin_s + 0.55, "base_link", "lidar", T_base_lidar);
    addTransform(bag, "/tf", kBegin_s + 3.0, "base_link", "lidar", T_base_lidar);
    addDrive(bag, T_base_lidar);
  }
  const Recording recording = read();
  EXPECT_EQ(recording.detector_frames.size(), kFrames) << "the first ones waited";
  expectInPlace(recording);
}

TEST_F(BagGatesTest, ASensorThatMovesOnTheRobotIsWhereItWasAtTheStamp) {
  objects_frame_ = "camera";
  const auto T_base_camera = [](int i) { return Pose{expRotation({0.0, 0.0, 0.05 * i}), {0.5, 0.0, 1.0}}; };
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    for (int i = 0; i < kFrames; ++i) {
      if (i % 2 == 0) addTransform(bag, "/tf", timeAt(i), "base_link", "camera", T_base_camera(i));
      addFrame(bag, i, odometryAt(i).T_world_base * T_base_camera(i));
    }
    addTransform(bag, "/tf", timeAt(kFrames), "base_link", "camera", T_base_camera(kFrames));
  }
  const Recording recording = read();
  EXPECT_EQ(recording.detector_frames.size(), kFrames);
  expectInPlace(recording);
}

TEST_F(BagGatesTest, ObjectsInTheFrameOfTheOdometryAreTransformedAtTheirStamp) {
  objects_frame_ = "odom";
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    for (int i = 0; i < kFrames; ++i) addFrame(bag, i, Pose::identity());
  }
  const Recording recording = read();
  EXPECT_EQ(recording.detector_frames.size(), kFrames);
  expectInPlace(recording);
}

TEST_F(BagGatesTest, ObjectsInTheMapAreRefusedAndTheRunSaysSo) {
  objects_frame_ = "tile";
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addTransform(bag, "/tf_static", kBegin_s, "map", "tile", Pose::identity());
    addTransform(bag, "/tf_static", kBegin_s, "map", "odom", Pose::identity());
    addDrive(bag);
  }
  EXPECT_EQ(read().refused.objects_in_map_frame, static_cast<std::size_t>(kFrames));
  expectInputError([&] { run(); }, {"no objects could be used", "/objects: 60 messages", "frame of the map"});
}

TEST_F(BagGatesTest, AnUnconnectedSensorIsNamed) {
  objects_frame_ = "lidar";
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addDrive(bag);
  }
  expectInputError([&] { run(); }, {"no transform from 'lidar' to 'base_link'", "60 messages"});
}

TEST_F(BagGatesTest, OneUnknownClassDropsItsObjectNotTheRun) {
  change_objects_ = [](int i, SemanticObjectArray& message) {
    if (i == 7) message.objects[1].class_id = 77;
  };
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addDrive(bag);
  }
  const Recording recording = read();
  EXPECT_EQ(recording.refused.unknown_classes, (std::map<int, std::size_t>{{77, 1}}));
  EXPECT_EQ(run().counters.detections, 2U * kFrames - 1U);
}

TEST_F(BagGatesTest, OneStampInTheFutureCostsOneMessageOfEitherKind) {
  const std::map<int, double> ahead_s = {{0, 3600.0}, {1, 5.0}, {30, 30.0}};  // frame -> of the odometry
  for (const auto& [outlier, odometry_s] : ahead_s) {
    change_odometry_ = [ahead = odometry_s](int i, nav_msgs::Odometry& message) {
      if (i == 30) message.header.stamp += ros::Duration(ahead);
    };
    change_objects_ = [frame = outlier](int i, SemanticObjectArray& message) {
      if (i == frame) message.header.stamp += ros::Duration(frame == 1 ? 5.0 : 3600.0);
    };
    {
      rosbag::Bag bag(path_, rosbag::bagmode::Write);
      addDrive(bag);
    }
    const RunResult result = run();
    EXPECT_EQ(read().refused.odometry_stamp_outliers, 1U);
    EXPECT_EQ(result.counters.odometry, kFrames - 1U);
    EXPECT_EQ(result.counters.frames, kFrames - 1U) << outlier;
    EXPECT_EQ(result.trajectory.back().stamp, odometryAt(kFrames - 1).stamp);
  }
}

TEST_F(BagGatesTest, WhatStillWaitsWhenTheBagEndsIsCounted) {
  change_odometry_ = [](int i, nav_msgs::Odometry& message) {
    if (i >= 50) message.header.frame_id = "elsewhere";  // as if the odometry had ended
    if (i == 49) message.header.stamp += ros::Duration(3600.0);
  };
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addDrive(bag);
  }
  EXPECT_EQ(read().refused.odometry_stamp_outliers, 1U);
  const RunResult result = run();
  EXPECT_EQ(result.counters.frames, 49U);
  EXPECT_EQ(result.counters.frames_waiting_too_long, kFrames - 49U);
}

TEST_F(BagGatesTest, AClockThatFallsBackBeginsANewMapAndWhatWasBeforeIsCounted) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addDrive(bag);
    change_odometry_ = [](int, nav_msgs::Odometry& message) { message.header.stamp -= ros::Duration(500.0); };
    change_objects_ = [](int, SemanticObjectArray& message) { message.header.stamp -= ros::Duration(500.0); };
    for (int i = 0; i < 20; ++i) {  // later in the bag, earlier by its stamps
      nav_msgs::Odometry odometry = toOdometry(odometryAt(i), "odom", "base_link");
      odometry.header.stamp -= ros::Duration(500.0);
      bag.write("/odometry", ros::Time(timeAt(kFrames + i)), odometry);
      SemanticObjectArray objects = toMessage(odometryAt(i).stamp, "base_link", {Detection()}, classes_);
      objects.objects[0].position.x = 5.0;
      objects.header.stamp = odometry.header.stamp;
      bag.write("/objects", ros::Time(timeAt(kFrames + i)), objects);
    }
  }
  const Recording recording = read();
  EXPECT_EQ(recording.odometry.size(), 20U);
  EXPECT_EQ(recording.refused.odometry_before_jump, static_cast<std::size_t>(kFrames));
  EXPECT_EQ(recording.refused.objects_before_jump, static_cast<std::size_t>(kFrames));
  EXPECT_EQ(run().counters.frames, 20U);
}

TEST_F(BagGatesTest, ABagOfWhichNothingCanBeUsedIsAnErrorThatNamesTheCause) {
  change_odometry_ = [](int, nav_msgs::Odometry& message) { message.header.stamp = ros::Time(); };
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addDrive(bag);
  }
  expectInputError([&] { run(); }, {"no odometry sample could be used", "/odometry: 60 messages", "stamp is zero"});
  odom_frame_ = "camera_init";
  change_odometry_ = nullptr;
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addDrive(bag);
  }
  expectInputError([&] { run(); }, {"/odometry", "'camera_init'", "node.odom_frame"});
}

TEST_F(BagGatesTest, IfNoClassIsInTheTableTheErrorNamesTheFix) {
  change_objects_ = [](int, SemanticObjectArray& message) {
    for (SemanticObject& object : message.objects) object.class_id = 77;
  };
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addDrive(bag);
  }
  expectInputError([&] { run(); }, {"no objects could be used", "120 objects dropped: class id '77'",
                                    "--set class_table=FILE", "class_table:=FILE"});
}

TEST_F(BagGatesTest, SlowOdometryIsNamed) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    for (int i = 0; i < kFrames; ++i) {
      const double time_s = kBegin_s + 1.1 * i;
      bag.write("/odometry", ros::Time(time_s),
                toOdometry({stampFromSeconds(time_s), Pose::identity()}, "odom", "base_link"));
      Detection detection;
      detection.position_m = {5.0, 1.0, 0.0};
      bag.write("/objects", ros::Time(time_s + 0.5),
                toMessage(stampFromSeconds(time_s + 0.5), "base_link", {detection}, classes_));
    }
  }
  expectInputError([&] { run(); }, {"no objects could be used", "input.max_odometry_gap", "/objects: 59 messages"});
}

}  // namespace
}  // namespace semantic_mht_slam
