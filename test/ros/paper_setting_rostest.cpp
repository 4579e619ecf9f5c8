// A node with the paper's own setting, config/paper.yaml, on a simulated drive: everything that the paper's chain is
// made of (FLANN's indices, the decision tree of OpenCV, sample consensus of PCL) gives in the node what it gives
// offline.
#include <mutex>
#include <vector>

#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <semantic_mht_slam/LoopClosure.h>
#include <semantic_mht_slam/SaveMap.h>
#include <semantic_mht_slam/SemanticMap.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/ros/service_call.h"

#include "support/running_node.h"
#include "support/simulated_rounds.h"
#include "support/spinner.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

constexpr Stamp kOrigin = 1000LL * 1000000000LL;

/// A recording as the messages that the node gets.
struct Messages {
  std::vector<nav_msgs::Odometry> odometry;
  std::vector<SemanticObjectArray> objects;
};

Messages toMessages(const Recording& recording, const ClassTable& classes) {
  Messages messages;
  for (StampedPose pose : recording.odometry) {
    pose.stamp += kOrigin;
    messages.odometry.push_back(toOdometry(pose, "odom", "base_link"));
  }
  for (const DetectorFrame& frame : recording.detector_frames) {
    messages.objects.push_back(toMessage(frame.stamp + kOrigin, "base_link", frame.detections, classes));
  }
  return messages;
}

Recording fromMessages(const Messages& messages, const ClassTable& classes) {
  Recording recording;
  for (const nav_msgs::Odometry& message : messages.odometry) {
    recording.odometry.push_back({toStamp(message.header.stamp), fromMessage(message.pose.pose)});
  }
  std::size_t unknown = 0;
  for (const SemanticObjectArray& message : messages.objects) {
    recording.detector_frames.push_back(
        {toStamp(message.header.stamp), fromMessage(message, classes, Pose::identity(), unknown)});
  }
  return recording;
}

class PaperSettingTest : public ::testing::Test {
 protected:
  PaperSettingTest() {
    odometry_ = handle_.advertise<nav_msgs::Odometry>("odometry", 10000);
    objects_ = handle_.advertise<SemanticObjectArray>("objects", 10000);
    subscribers_.push_back(handle_.subscribe<nav_msgs::Path>("trajectory", 10, [this](const nav_msgs::PathConstPtr& m) {
      const std::lock_guard<std::mutex> lock(mutex_);
      trajectory_ = *m;
    }));
    subscribers_.push_back(handle_.subscribe<SemanticMap>("map", 100, [this](const SemanticMapConstPtr& m) {
      const std::lock_guard<std::mutex> lock(mutex_);
      map_ = *m;
    }));
    subscribers_.push_back(handle_.subscribe<LoopClosure>("loop_closures", 10000, [this](const LoopClosureConstPtr& m) {
      const std::lock_guard<std::mutex> lock(mutex_);
      closures_.push_back(*m);
    }));
  }

  void play(const Messages& messages) {
    ASSERT_TRUE(waitFor([this] {
      if (odometry_.getNumSubscribers() == 0 || objects_.getNumSubscribers() == 0) return false;
      for (const ros::Subscriber& subscriber : subscribers_) {
        if (subscriber.getNumPublishers() == 0) return false;
      }
      return true;
    }));
    for (std::size_t i = 0; i < messages.odometry.size(); ++i) {
      objects_.publish(messages.objects[i]);
      odometry_.publish(messages.odometry[i]);
      ros::WallDuration(0.005).sleep();
    }
    ASSERT_TRUE(waitFor(
        [&] {
          const std::lock_guard<std::mutex> lock(mutex_);
          return trajectory_.poses.size() == messages.odometry.size();
        },
        120.0));
    std_srvs::Trigger finish;
    ASSERT_TRUE(callService("finish_submap", finish));
    ASSERT_TRUE(finish.response.success) << finish.response.message;
  }

  ros::NodeHandle handle_;
  ros::Publisher odometry_;
  ros::Publisher objects_;
  std::vector<ros::Subscriber> subscribers_;
  std::mutex mutex_;
  nav_msgs::Path trajectory_;
  SemanticMap map_;
  std::vector<LoopClosure> closures_;
};

void expectClosures(const std::vector<LoopClosure>& closures, const std::vector<LoopClosureResult>& expected) {
  ASSERT_EQ(closures.size(), expected.size());
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const LoopClosureRecord& record = expected[i].record;
    EXPECT_EQ(closures[i].inliers, static_cast<std::uint32_t>(record.inliers)) << "closure " << i;
    EXPECT_EQ(closures[i].histogram_divergence, record.place.histogram_divergence) << "closure " << i;
    EXPECT_GE(closures[i].histogram_divergence, 0.0) << "closure " << i << " comes from the paper's chain";
    EXPECT_GE(closures[i].topology_score, -1.0) << "closure " << i;
    EXPECT_GE(closures[i].loop_prob, 0.0) << "closure " << i;
    accepted += closures[i].accepted ? 1 : 0;
  }
  EXPECT_GT(accepted, 0U);
}

TEST_F(PaperSettingTest, ANodeGivesMapClosuresFeaturesAndTrajectoryAsOffline) {
  const std::string file = packageConfigFile("paper.yaml");
  const SystemConfig config = loadSystemConfig(file, {});
  const SlamConfig slam_config = loadableSlamConfig(config, "");
  const ClassTable classes = loadClassTable(config, "");
  const Messages messages = toMessages(toRecording(simulateRounds(classes)), classes);
  play(messages);
  const RunResult expected =
      runOffline(fromMessages(messages, classes), slam_config, classes, [](std::size_t, std::size_t) {});

  SaveMap save;
  const TemporaryFolder folder;
  save.request.path = folder / "map.bag";
  ASSERT_TRUE(callService("save_map", save));
  ASSERT_TRUE(save.response.success) << save.response.message;
  const LoadedMap loaded = readMapFile(save.request.path, config, classes, [] { return true; });
  EXPECT_TRUE(loaded.has_same_parameters) << "the node runs with the file's parameters and no others";
  const Slam saved(slam_config, classes, loaded.state);
  const IdVector<SubmapId, SubmapCheck>& checks = saved.parts().closer->checks();
  ASSERT_EQ(checks.size(), expected.submap_checks.size());
  std::size_t searched = 0;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    EXPECT_EQ(checks[SubmapId(i)].evaluation.good_prob, expected.submap_checks[i].check.evaluation.good_prob)
        << "submap " << i;
    searched += checks[SubmapId(i)].is_checked ? 1 : 0;
  }
  EXPECT_GT(searched, 0U);
  EXPECT_LT(searched, checks.size()) << "the tree passes over what shows next to nothing";

  ASSERT_TRUE(waitFor([&] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return map_.submaps == expected.submaps && closures_.size() >= expected.loop_closures.size();
  }));
  ros::WallDuration(1.5).sleep();  // the corrected trajectory follows
  const std::lock_guard<std::mutex> lock(mutex_);
  EXPECT_EQ(map_.landmarks.size(), expected.landmarks.size());
  EXPECT_GE(map_.landmarks.size(), 50U);
  expectClosures(closures_, expected.loop_closures);
  ASSERT_EQ(trajectory_.poses.size(), expected.trajectory.size());
  for (std::size_t i = 0; i < expected.trajectory.size(); ++i) {
    ASSERT_EQ(fromMessage(trajectory_.poses[i].pose).translation_m, expected.trajectory[i].T_world_base.translation_m)
        << "pose " << i;
  }
}

}  // namespace
}  // namespace semantic_mht_slam
