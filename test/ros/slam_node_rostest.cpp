#include <cstdlib>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/ros/service_call.h"

#include "support/recordings.h"
#include "support/spinner.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

constexpr std::size_t kFrames = 120;
constexpr Stamp kOrigin = 1000000000;

/// Listens to what the node publishes while a bag is replayed into it.
class SlamNodeTest : public ::testing::Test {
 protected:
  SlamNodeTest() : transform_listener_(transforms_) {
    subscribers_.push_back(handle_.subscribe<HypothesisTree>(
        "hypotheses", 1000, [this](const HypothesisTreeConstPtr& m) { trees_.push_back(*m); }));
    subscribers_.push_back(
        handle_.subscribe<SemanticMap>("map", 10, [this](const SemanticMapConstPtr& m) { map_ = *m; }));
    subscribers_.push_back(
        handle_.subscribe<rosgraph_msgs::Log>("/rosout", 100, [this](const rosgraph_msgs::LogConstPtr& m) {
          const std::lock_guard<std::mutex> lock(warnings_mutex_);
          if (m->level >= rosgraph_msgs::Log::WARN) warnings_.push_back(m->msg);
        }));
    subscribers_.push_back(handle_.subscribe<nav_msgs::Path>(
        "trajectory", 10, [this](const nav_msgs::PathConstPtr& m) { trajectory_ = *m; }));
    subscribers_.push_back(handle_.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
        "pose", 1000, [this](const geometry_msgs::PoseWithCovarianceStampedConstPtr& m) { poses_.push_back(*m); }));
    subscribers_.push_back(handle_.subscribe<visualization_msgs::MarkerArray>(
        "markers/objects", 1000, [this](const visualization_msgs::MarkerArrayConstPtr& m) { markers_.push_back(*m); }));
  }

  /// Waits until a warning with this text is on /rosout.
  bool sawWarning(const std::string& text) const {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10.0);
    while (ros::WallTime::now() < deadline) {
      {
        const std::lock_guard<std::mutex> lock(warnings_mutex_);
        for (const std::string& warning : warnings_) {
          if (warning.find(text) != std::string::npos) return true;
        }
      }
      ros::WallDuration(0.05).sleep();
    }
    return false;
  }

  /// Plays a bag at ten times real time and waits until trajectory and detector frames end at `last`.
  void play(const std::string& bag, Stamp last) {
    const std::string command =
        "rosbag play --quiet --clock --wait-for-subscribers --rate 10 --topics /objects "
        "/odometry /tf /tf_static --bags '" +
        bag + "' > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
    const auto isAtEnd = [&] {
      return toStamp(trajectory_.header.stamp) == last && !trees_.empty() &&
             toStamp(trees_.back().header.stamp) == last;
    };
    while (!isAtEnd() && ros::WallTime::now() < deadline) ros::WallDuration(0.05).sleep();
    ASSERT_TRUE(isAtEnd()) << "the trajectory or the frames do not reach the end of the bag";
  }

  /// Ends the last submap, as the offline runner does, and waits for the trajectory that follows from it.
  void finishSubmap() {
    trajectory_ = {};
    std_srvs::Trigger finish;
    ASSERT_TRUE(callService("finish_submap", finish));
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
    while (trajectory_.poses.empty() && ros::WallTime::now() < deadline) ros::WallDuration(0.05).sleep();
  }

  /// The trajectory of the offline runner on the same bag, stamps of the bag.
  static std::vector<StampedPose> offlineTrajectory(const std::string& bag, const ClassTable& classes) {
    return runOffline(readBag(bag, classes, {}, {}), SlamConfig{}, classes, [](std::size_t, std::size_t) {}).trajectory;
  }

  void expectTrajectory(const std::vector<StampedPose>& expected) const {
    ASSERT_EQ(trajectory_.poses.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Pose pose = fromMessage(trajectory_.poses[i].pose);
      EXPECT_EQ(toStamp(trajectory_.poses[i].header.stamp), expected[i].stamp + kOrigin);
      EXPECT_EQ(pose.translation_m, expected[i].T_world_base.translation_m) << "pose " << i;
      EXPECT_EQ(pose.rotation.coeffs(), expected[i].T_world_base.rotation.coeffs()) << "pose " << i;
    }
  }

  ros::NodeHandle handle_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  std::vector<ros::Subscriber> subscribers_;
  nav_msgs::Path trajectory_;
  std::vector<geometry_msgs::PoseWithCovarianceStamped> poses_;
  std::vector<visualization_msgs::MarkerArray> markers_;
  std::vector<HypothesisTree> trees_;
  SemanticMap map_;
  mutable std::mutex warnings_mutex_;
  std::vector<std::string> warnings_;
};

TEST_F(SlamNodeTest, ReplayedBagGivesTheOfflineTrajectoryAndALaterOneStartsAgain) {
  const ClassTable classes = loadClassTable(SystemConfig{}, "");
  const TemporaryFolder folder;
  const std::string bag = folder / "circle.bag";
  const Recording recording = makeCircleRecording(kFrames);
  writeBag(bag, recording, classes, {}, {}, kOrigin);
  const Stamp last = recording.odometry.back().stamp + kOrigin;
  const std::vector<StampedPose> expected = offlineTrajectory(bag, classes);

  play(bag, last);
  finishSubmap();
  expectTrajectory(expected);
  EXPECT_EQ(trajectory_.header.frame_id, "map");
  ASSERT_EQ(poses_.size(), kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(toStamp(poses_[i].header.stamp), recording.odometry[i].stamp + kOrigin);
    EXPECT_EQ(poses_[i].header.frame_id, "map");
    const auto cov = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(poses_[i].pose.covariance.data());
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(cov).info(), Eigen::Success) << "pose " << i;
    EXPECT_EQ(cov, cov.transpose()) << "pose " << i;
  }
  EXPECT_LT(poses_.front().pose.covariance[0], 1e-3) << "the map begins at the first pose";
  EXPECT_GT(poses_.back().pose.covariance[0], poses_.front().pose.covariance[0]);
  const auto T_map_odom = transforms_.lookupTransform("map", "odom", toRosTime(last));
  const Pose T_map_base = fromMessage(T_map_odom.transform) * recording.odometry.back().T_world_base;
  EXPECT_NEAR((T_map_base.translation_m - fromMessage(poses_.back().pose.pose).translation_m).norm(), 0.0, 1e-9)
      << "tf and pose agree";
  EXPECT_TRUE(transforms_.canTransform("map", "velodyne", toRosTime(last)));

  EXPECT_EQ(trees_.size(), kFrames);
  for (const HypothesisTree& tree : trees_) {
    double weight = 0.0;
    for (const auto& hypothesis : tree.hypotheses) weight += hypothesis.weight;
    EXPECT_NEAR(weight, 1.0, 1e-9);
  }
  ASSERT_GE(map_.submaps, 1U) << "a circle of 96 m has finished submaps";
  for (const Landmark& landmark : map_.landmarks) EXPECT_GE(landmark.existence_prob, 0.5);

  ASSERT_EQ(markers_.size(), kFrames) << "one marker array a detector frame, empty frames included";
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(markers_[i].markers.size(), 2 + i % 4) << "frame " << i;
    EXPECT_EQ(markers_[i].markers.front().action, visualization_msgs::Marker::DELETEALL);
  }
  const Detection& object = recording.detector_frames[1].detections[0];
  const Eigen::Vector3d in_map = recording.odometry[1].T_world_base * object.position_m;
  EXPECT_NEAR((fromMessage(markers_[1].markers.back().pose).translation_m - in_map).norm(), 0.0, 1e-12);

  // The same bag again: the clock jumps back, the old trajectory is forgotten.
  trajectory_ = {};
  poses_.clear();
  trees_.clear();
  play(bag, last);
  finishSubmap();
  expectTrajectory(expected);
  EXPECT_EQ(poses_.size(), kFrames);
  EXPECT_EQ(trees_.size(), 1 + kFrames) << "the empty tree of the new map, and the frames";
}

TEST_F(SlamNodeTest, WrongInputIsNamedInAWarningAndOneWrongStampChangesNothing) {
  ros::Publisher odometry = handle_.advertise<nav_msgs::Odometry>("odometry", 100);
  ros::Publisher objects = handle_.advertise<SemanticObjectArray>("objects", 100);
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10.0);
  while ((odometry.getNumSubscribers() == 0 || objects.getNumSubscribers() == 0) && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.05).sleep();
  }
  const Stamp begin = 50 * kOrigin;
  const auto publish = [&](Stamp stamp, const std::string& frame) {
    odometry.publish(toOdometry({stamp, Pose::identity()}, frame, "base_link"));
  };
  publish(begin, "odom");
  publish(begin + kOrigin / 10, "camera_init");
  EXPECT_TRUE(sawWarning("'camera_init'"));
  objects.publish(toMessage(begin, "nowhere", {}, makeTwoClasses()));
  for (int i = 1; i <= 40; ++i) {
    publish(begin + i * kOrigin / 10, "odom");
    if (i == 20) publish(1, "odom");  // falls back to the beginning, once
    ros::WallDuration(0.1).sleep();
  }
  EXPECT_TRUE(sawWarning("'nowhere'")) << "objects of a frame that tf does not know";
  ros::WallDuration(0.5).sleep();
  EXPECT_EQ(toStamp(trajectory_.header.stamp), begin + 4 * kOrigin);
  EXPECT_GE(trajectory_.poses.size(), 41U);
}

constexpr std::uint16_t kPoleId = 80;  // of config/classes_semantic_kitti.yaml

TEST_F(SlamNodeTest, ObjectsThatOvertakeTheOdometryOfAJumpBelongToTheNewMap) {
  std_srvs::Trigger reset;  // whoever is lost would look for the place instead of beginning a new map
  ASSERT_TRUE(callService("reset", reset) && reset.response.success);
  ros::Publisher odometry = handle_.advertise<nav_msgs::Odometry>("odometry", 100);
  ros::Publisher objects = handle_.advertise<SemanticObjectArray>("objects", 100);
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10.0);
  while ((odometry.getNumSubscribers() == 0 || objects.getNumSubscribers() == 0) && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.05).sleep();
  }
  const auto publish = [&](Stamp stamp) {
    odometry.publish(toOdometry({stamp, Pose::identity()}, "odom", "base_link"));
    ros::WallDuration(0.02).sleep();
  };
  const auto poles = [](Stamp stamp) {  // enough to know the range of the detector, which the first frames wait for
    SemanticObjectArray message = toMessage(stamp, "base_link", Detections(30), makeTwoClasses());
    for (std::size_t i = 0; i < message.objects.size(); ++i) {
      message.objects[i].class_id = kPoleId;
      message.objects[i].position.x = 20.0;
      message.objects[i].position.y = 2.0 * static_cast<double>(i) - 29.0;
    }
    return message;
  };
  objects.publish(poles(100 * kOrigin + kOrigin / 20));
  for (int i = 0; i < 10; ++i) publish(100 * kOrigin + i * kOrigin / 10);
  ros::WallDuration(0.3).sleep();
  trees_.clear();
  const Stamp begin = 20 * kOrigin;
  objects.publish(poles(begin));
  ros::WallDuration(0.2).sleep();  // the node has read the objects before the first odometry of the new time
  for (int i = 0; i < 10; ++i) publish(begin + i * kOrigin / 10);
  ros::WallDuration(0.5).sleep();
  ASSERT_EQ(trees_.size(), 2U) << "the empty tree of the new map, and the frame";
  EXPECT_EQ(toStamp(trees_.back().header.stamp), begin);
}

TEST_F(SlamNodeTest, ObjectsThatAreMerelyLateWaitForNothing) {
  ros::Publisher odometry = handle_.advertise<nav_msgs::Odometry>("odometry", 100);
  ros::Publisher objects = handle_.advertise<SemanticObjectArray>("objects", 100);
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10.0);
  while ((odometry.getNumSubscribers() == 0 || objects.getNumSubscribers() == 0) && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.05).sleep();
  }
  const Stamp begin = 200 * kOrigin;
  const auto sendObjects = [&](int i) {
    objects.publish(toMessage(begin + i * kOrigin / 10, "base_link", {}, makeTwoClasses()));
  };
  sendObjects(0);
  for (int i = 0; i <= 80; ++i) {
    odometry.publish(toOdometry({begin + i * kOrigin / 10, Pose::identity()}, "odom", "base_link"));
    ros::WallDuration(0.01).sleep();
  }
  ros::WallDuration(0.5).sleep();
  const std::size_t before = trees_.size();
  for (int i = 1; i <= 5; ++i) sendObjects(i);  // more than 7 s late
  const ros::WallTime sent = ros::WallTime::now();
  while (trees_.size() < before + 5 && ros::WallTime::now() < sent + ros::WallDuration(10.0)) {
    ros::WallDuration(0.01).sleep();
  }
  EXPECT_LT((ros::WallTime::now() - sent).toSec(), 1.0);
}

/// Runs a second node with one wrong parameter and returns its exit code.
int exitCodeWith(const std::string& argument) {
  const std::string program = std::string(SMHT_PROGRAM_DIR) + "/slam_node";
  const int status = std::system(("'" + program + "' __name:=refused " + argument + " > /dev/null 2>&1").c_str());
  return WEXITSTATUS(status);
}

TEST(SlamNodeParametersTest, UnknownOrBadParametersEndTheNodeWithCode1) {
  EXPECT_EQ(exitCodeWith("_no_such_parameter:=1"), 1);
  EXPECT_EQ(exitCodeWith("_node/queue_size:=0"), 1);
  EXPECT_EQ(exitCodeWith("_class_table:=nowhere.yaml"), 1);
}

}  // namespace
}  // namespace semantic_mht_slam
