#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <mutex>
#include <set>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <semantic_mht_slam/GetLandmarks.h>
#include <semantic_mht_slam/LoadMap.h>
#include <semantic_mht_slam/SaveMap.h>
#include <semantic_mht_slam/SemanticMap.h>
#include <semantic_mht_slam/SetMode.h>

#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/ros/service_call.h"

#include "support/driving_node.h"
#include "support/spinner.h"
#include "support/square_drive.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

/// A map of the node's default parameters and class table, with `ballast` megabytes that nobody needs.
std::string writeMap(const std::string& path, int frames, int ballast) {
  const SystemConfig config;
  const ClassTable classes = loadClassTable(config, "");
  Slam slam(config.slam, classes);
  SquareDrive(2).feed(slam, 0, frames);
  SavedMap map = mapOf(slam);
  Rng rng(3);
  for (int i = 0; i < ballast; ++i) {
    StateSection section{"ballast", 1, std::string(1U << 20U, ' ')};
    for (char& byte : section.bytes) byte = static_cast<char>(rng.bits());
    map.state.sections.push_back(std::move(section));
  }
  writeMapFile(path, map, config, classes);
  return path;
}

TEST(MapServicesTest, SaveLoadAndGoOnEqualsNeverHavingStopped) {
  const TemporaryFolder folder;
  const std::string path = folder / "map.bag";
  std::vector<geometry_msgs::PoseStamped> expected;
  {
    DrivingNode first("first");
    ASSERT_TRUE(first.isReady());
    ASSERT_TRUE(first.feed(0, 300));
    const SaveMap::Response saved = first.save(path);
    ASSERT_TRUE(saved.success) << saved.message;
    EXPECT_EQ(saved.bytes, std::filesystem::file_size(path));
    ASSERT_TRUE(first.feed(300, 600));
    expected = first.finalTrajectory(600);
  }
  DrivingNode second("second");
  ASSERT_TRUE(second.isReady());
  const LoadMap::Response loaded = second.load(path);
  ASSERT_TRUE(loaded.success) << loaded.message;
  ASSERT_TRUE(second.feed(300, 600));
  const std::vector<geometry_msgs::PoseStamped> trajectory = second.finalTrajectory(600);
  ASSERT_EQ(trajectory.size(), expected.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) ASSERT_EQ(trajectory[i], expected[i]) << i;
}

TEST(MapServicesTest, LandmarksAreInTheMapBeforeTheFirstSubmapIsFinished) {
  DrivingNode driving("early");
  ASSERT_TRUE(driving.isReady());
  std::mutex mutex;
  SemanticMap map;
  const ros::Subscriber subscriber = driving.node.handle().subscribe<SemanticMap>(
      "map", 10, boost::function<void(const SemanticMapConstPtr&)>([&](const SemanticMapConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        map = *message;
      }));
  ASSERT_TRUE(driving.feed(0, 20));
  ASSERT_TRUE(waitFor([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return !map.landmarks.empty();
  }));
  EXPECT_EQ(driving.node.value("estimator", "submaps"), "0");
  const GetLandmarks::Response early = driving.call<GetLandmarks>("get_landmarks");
  ASSERT_TRUE(early.success) << early.message;
  ASSERT_FALSE(early.landmarks.empty());
  for (const Landmark& landmark : early.landmarks) EXPECT_TRUE(landmark.provisional) << landmark.id;
  EXPECT_TRUE(driving.call<std_srvs::Trigger>("finish_submap").success);
  const GetLandmarks::Response finished = driving.call<GetLandmarks>("get_landmarks");
  for (const Landmark& landmark : finished.landmarks) EXPECT_FALSE(landmark.provisional) << landmark.id;
  std::set<std::uint64_t> ids;
  for (const Landmark& landmark : finished.landmarks) ids.insert(landmark.id);
  for (const Landmark& landmark : early.landmarks) EXPECT_EQ(ids.count(landmark.id), 1U) << "ids stay";
}

TEST(MapServicesTest, FilesThatCannotBeUsedLeaveTheRunningMap) {
  const TemporaryFolder folder;
  const std::string good = writeMap(folder / "good.bag", 100, 0);
  const std::string text = folder / "text.bag";
  writeFileAtomically(text, "no bag");
  const std::string cut = folder / "cut.bag";
  const std::string content = readFile(good);
  writeFileAtomically(cut, content.substr(0, content.size() / 2));
  DrivingNode driving("refusing");
  ASSERT_TRUE(driving.isReady());
  ASSERT_TRUE(driving.feed(0, 100));
  const std::string submaps = driving.node.value("estimator", "submaps");
  for (const std::string& path : {text, cut, folder / "missing.bag", folder.path()}) {
    const LoadMap::Response response = driving.load(path);
    EXPECT_FALSE(response.success);
    EXPECT_NE(response.message.find(path), std::string::npos) << response.message;
    EXPECT_NE(response.message.find("the running map stays"), std::string::npos) << response.message;
  }
  EXPECT_NE(driving.save("/no/such/folder/map.bag").message.find("No such file"), std::string::npos);
  EXPECT_FALSE(driving.save(text).success);
  EXPECT_EQ(readFile(text), "no bag") << "only maps are replaced";
  ASSERT_TRUE(driving.feed(100, 110)) << "frames are counted on: the map is still there";
  EXPECT_EQ(driving.node.value("estimator", "submaps"), submaps);
  EXPECT_TRUE(driving.load(good).success);
}

TEST(MapServicesTest, AFolderForMapsKeepsTheServicesInIt) {
  const TemporaryFolder folder;
  const std::string maps = folder / "maps";
  prepareOutputFolder(maps);
  DrivingNode driving("kept_in", {"_node/map_folder:=" + maps});
  ASSERT_TRUE(driving.isReady());
  ASSERT_TRUE(driving.feed(0, 60));
  EXPECT_FALSE(driving.save(folder / "map.bag").success);
  EXPECT_TRUE(std::filesystem::is_empty(maps));
  const SaveMap::Response saved = driving.save("map.bag");
  EXPECT_NE(saved.message.find(maps + "/map.bag"), std::string::npos) << saved.message;
  EXPECT_TRUE(driving.load("map.bag").success);
  EXPECT_FALSE(driving.load("../maps/../map.bag").success);
}

TEST(MapServicesTest, NodeThatIsKilledWhileSavingLeavesAWholeFile) {
  const TemporaryFolder folder;
  const SystemConfig config;
  const ClassTable classes = loadClassTable(config, "");
  const std::string old_map = writeMap(folder / "old.bag", 40, 0);
  const std::string path = folder / "map.bag";
  std::filesystem::copy_file(old_map, path);
  const std::string big = writeMap(folder / "big.bag", 700, 0);
  const std::string old_content = readFile(path);
  int untouched = 0;
  const char* more = std::getenv("SMHT_KILLS");
  const int kills = more == nullptr ? 4 : std::atoi(more);
  for (int trial = 0; trial < kills; ++trial) {
    DrivingNode driving("killed_" + std::to_string(trial));
    ASSERT_TRUE(driving.isReady());
    ASSERT_TRUE(driving.load(big).success);
    const std::string service = driving.node.handle().resolveName("save_map");
    ASSERT_TRUE(ros::service::waitForService(service, ros::Duration(10.0)));
    auto saving = std::async(std::launch::async, [&] {
      SaveMap save;
      save.request.path = path;
      callService(service, save);
    });
    ros::WallDuration(0.12 * trial / kills).sleep();
    EXPECT_GE(driving.node.process().stop(SIGKILL, 5.0), 0.0);
    saving.wait();
    if (readFile(path) == old_content) ++untouched;
    EXPECT_NO_THROW(readMapFile(path, config, classes, [] { return true; })) << trial;
    EXPECT_LE(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4)
        << "more than the newest temporary file is left";
  }
  EXPECT_GT(untouched, 0) << "none was killed before it had finished";
  writeMap(path, 40, 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3) << "the next save removes it";
}

TEST(MapServicesTest, AnotherDriveFindsItselfInALoadedMapAndLeavesItAsItIs) {
  const TemporaryFolder folder;
  const std::string path = folder / "map.bag";
  DrivingNode driving("localizing");
  ASSERT_TRUE(driving.isReady());
  SetMode::Request mode;
  mode.mode = SetMode::Request::LOCALIZATION;
  EXPECT_FALSE(driving.call<SetMode>("set_mode", mode).success) << "without a map";
  ASSERT_TRUE(driving.feed(0, 480));
  ASSERT_TRUE(driving.save(path).success);
  EXPECT_TRUE(driving.call<std_srvs::Trigger>("reset").success);
  ASSERT_TRUE(driving.load(path).success);
  ASSERT_TRUE(driving.call<SetMode>("set_mode", mode).success);
  const std::string submaps = driving.node.value("estimator", "submaps");
  ASSERT_TRUE(driving.feed(100, 110, 490)) << "stamps go back: another drive";
  EXPECT_TRUE(driving.node.comesToSay("estimator", "mode", "localization, lost"));
  EXPECT_TRUE(driving.node.comesToReport("estimator", "no pose goes out"));
  ASSERT_TRUE(driving.feed(110, 200, 580));
  EXPECT_TRUE(driving.node.comesToSay("estimator", "mode", "localization"));
  const std::string after = driving.node.value("estimator", "submaps");
  mode.mode = SetMode::Request::MAPPING;
  EXPECT_TRUE(driving.call<SetMode>("set_mode", mode).success);
  ASSERT_TRUE(driving.feed(200, 300, 680));
  EXPECT_TRUE(driving.call<std_srvs::Trigger>("finish_submap").success);
  EXPECT_TRUE(waitFor([&] { return driving.node.value("estimator", "submaps") != after; })) << "the map grows again";
}

TEST(MapServicesTest, PausedNodeUsesNoObjectsAndItsPoseGoesOn) {
  DrivingNode driving("pausing");
  ASSERT_TRUE(driving.isReady());
  EXPECT_FALSE(driving.call<std_srvs::Trigger>("resume").success) << "it is not paused";
  ASSERT_TRUE(driving.feed(0, 60));
  EXPECT_TRUE(driving.call<std_srvs::Trigger>("pause").success);
  EXPECT_FALSE(driving.call<std_srvs::Trigger>("pause").success) << "it is paused";
  EXPECT_TRUE(driving.node.comesToSay("estimator", "mode", "mapping, paused"));
  ASSERT_TRUE(driving.feed(60, 100, 60)) << "no frame is used";
  EXPECT_TRUE(driving.node.comesToSay("estimator", "objects not used while paused", "40"));
  EXPECT_TRUE(driving.node.comesToSay("odometry", "used", "100"));
  EXPECT_TRUE(driving.call<std_srvs::Trigger>("resume").success);
  ASSERT_TRUE(driving.feed(100, 160, 120));
  EXPECT_EQ(driving.finalTrajectory(160).size(), 160U);
  EXPECT_EQ(driving.node.value("estimator", "mode"), "mapping");
}

TEST(MapServicesTest, NothingIsLostWhileAMapIsLoaded) {
  const TemporaryFolder folder;
  const std::string path = writeMap(folder / "heavy.bag", 100, 20);
  DrivingNode driving("listening", {"_node/queue_size:=100000"});
  ASSERT_TRUE(driving.isReady());
  const std::string service = driving.node.handle().resolveName("load_map");
  ASSERT_TRUE(ros::service::waitForService(service, ros::Duration(10.0)));
  std::atomic<bool> is_loaded{false};
  auto loading = std::async(std::launch::async, [&] {
    LoadMap load;
    load.request.path = path;
    const bool is_answered = callService(service, load) && load.response.success;
    is_loaded = true;
    return is_answered;
  });
  int sent = 0;
  for (; sent < 3000 || !is_loaded; ++sent) {
    driving.node.sendOdometry(0.001 * sent);
    ros::WallDuration(0.0005).sleep();
  }
  EXPECT_TRUE(loading.get());
  EXPECT_TRUE(driving.node.comesToSay("odometry", "messages", std::to_string(sent)));
}

TEST(MapServicesTest, InterruptEndsTheNodeWithinTwoSecondsWhileItLoads) {
  const TemporaryFolder folder;
  const std::string path = writeMap(folder / "heavy.bag", 100, 150);
  DrivingNode driving("loading");
  ASSERT_TRUE(driving.isReady());
  const std::string service = driving.node.handle().resolveName("load_map");
  ASSERT_TRUE(ros::service::waitForService(service, ros::Duration(10.0)));
  auto loading = std::async(std::launch::async, [&] {
    LoadMap load;
    load.request.path = path;
    return callService(service, load) && load.response.success;
  });
  ros::WallDuration(0.5).sleep();
  const double seconds = driving.node.process().stop(SIGINT, 20.0);
  EXPECT_GE(seconds, 0.0);
  EXPECT_LT(seconds, 2.0);
  EXPECT_FALSE(loading.get()) << "the file was loaded before the interrupt";
}

}  // namespace
}  // namespace semantic_mht_slam
