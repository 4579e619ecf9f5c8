#include <filesystem>
#include <mutex>
#include <string>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <semantic_mht_slam/SemanticMap.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/driving_node.h"
#include "support/run_program.h"
#include "support/spinner.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

/// A map of one round of the square, by a node of its own.
std::string saveRound(const std::string& path) {
  DrivingNode driving("mapping");
  EXPECT_TRUE(driving.isReady());
  EXPECT_TRUE(driving.feed(0, 480));
  EXPECT_TRUE(driving.save(path).success);
  return path;
}

TEST(StartTest, NodeThatBeginsInAMapFindsItselfWithoutAService) {
  const TemporaryFolder folder;
  const std::string path = saveRound(folder / "map.bag");
  DrivingNode driving("booting", {"_node/map:=" + path, "_node/mode:=localization"});
  std::mutex mutex;
  std::size_t landmarks = 0;
  const ros::Subscriber subscriber = driving.node.handle().subscribe<SemanticMap>(
      "map", 1, boost::function<void(const SemanticMapConstPtr&)>([&](const SemanticMapConstPtr& map) {
        const std::lock_guard<std::mutex> lock(mutex);
        landmarks = map->landmarks.size();
      }));
  ASSERT_TRUE(driving.isReady());
  EXPECT_TRUE(waitFor([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return landmarks > 50;
  })) << "the map is there before the first message";
  EXPECT_TRUE(driving.node.comesToSay("estimator", "mode", "localization"));
  const std::string submaps = driving.node.value("estimator", "submaps");
  EXPECT_NE(submaps, "0");
  ASSERT_TRUE(driving.feed(100, 110, 490));
  EXPECT_TRUE(driving.node.comesToSay("estimator", "mode", "localization, lost")) << "another drive";
  ASSERT_TRUE(driving.feed(110, 200, 580));
  EXPECT_TRUE(driving.node.comesToSay("estimator", "mode", "localization"));
  EXPECT_EQ(driving.node.value("estimator", "submaps"), submaps) << "the map stays as it is";
}

TEST(StartTest, NodeThatBeginsInAMapGoesOnMapping) {
  const TemporaryFolder folder;
  DrivingNode driving("going_on", {"_node/map:=" + saveRound(folder / "map.bag")});
  ASSERT_TRUE(driving.isReady());
  EXPECT_TRUE(driving.node.comesToSay("estimator", "mode", "mapping"));
  ASSERT_TRUE(driving.feed(480, 560));
  EXPECT_TRUE(driving.call<std_srvs::Trigger>("finish_submap").success);
}

TEST(StartTest, WhatCannotBeBegunWithEndsTheNodeWithOneLine) {
  const TemporaryFolder folder;
  const std::string text = folder / "text.bag";
  writeFileAtomically(text, "no bag");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"_node/map:=" + text, text},
      {"_node/map:=" + (folder / "missing.bag"), "missing.bag': no such file"},
      {"_node/map:=town.bag", "node/map: 'town.bag' is no absolute path"},
      {"_node/mode:=localization", "node/mode is localization, and node/map names no map file"},
      {"_node/mode:=tracking", "tracking"}};
  for (const auto& [parameter, problem] : cases) {
    const ProgramResult result = runProgramOfPackage("slam_node", "__name:=wrong_start '" + parameter + "'");
    EXPECT_EQ(result.exit_code, 1) << parameter;
    EXPECT_NE(result.output.find(problem), std::string::npos) << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
    EXPECT_EQ(std::system("rosparam delete /wrong_start > /dev/null"), 0);
  }
}

/// Feeds a node and tells whether tf came from its map frame once its pose had come several times.
bool publishesTf(const std::string& name, const std::vector<std::string>& parameters) {
  std::mutex mutex;
  std::size_t poses = 0;
  std::size_t transforms = 0;
  RunningNode node(name, parameters);
  const ros::Subscriber pose_subscriber = node.handle().subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "pose", 100,
      boost::function<void(const geometry_msgs::PoseWithCovarianceStampedConstPtr&)>(
          [&](const geometry_msgs::PoseWithCovarianceStampedConstPtr& m) {
            const std::lock_guard<std::mutex> lock(mutex);
            if (m->header.frame_id == "map_of_" + name) ++poses;
          }));
  const ros::Subscriber tf_subscriber = node.handle().subscribe<tf2_msgs::TFMessage>(
      "/tf", 1000, boost::function<void(const tf2_msgs::TFMessageConstPtr&)>([&](const tf2_msgs::TFMessageConstPtr& m) {
        const std::lock_guard<std::mutex> lock(mutex);
        for (const auto& transform : m->transforms) transforms += transform.header.frame_id == "map_of_" + name ? 1 : 0;
      }));
  EXPECT_TRUE(node.isReady());
  double time_s = 0.0;
  EXPECT_TRUE(waitFor([&] {
    node.sendOdometry(time_s += 0.1);
    const std::lock_guard<std::mutex> lock(mutex);
    return poses > 50;
  }));
  const std::lock_guard<std::mutex> lock(mutex);
  return transforms > 0;
}

TEST(StartTest, TfCanBeLeftToOthers) {
  EXPECT_TRUE(publishesTf("loud", {"_node/map_frame:=map_of_loud"}));
  EXPECT_FALSE(publishesTf("quiet", {"_node/map_frame:=map_of_quiet", "_node/publish_tf:=false"}));
}

}  // namespace
}  // namespace semantic_mht_slam
