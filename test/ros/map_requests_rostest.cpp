#include <filesystem>
#include <mutex>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <semantic_mht_slam/AddClosure.h>
#include <semantic_mht_slam/AmbiguousDetections.h>
#include <semantic_mht_slam/GetLandmarks.h>
#include <semantic_mht_slam/LockLandmark.h>
#include <semantic_mht_slam/RemoveClosure.h>
#include <semantic_mht_slam/RemoveLandmark.h>
#include <semantic_mht_slam/SaveResults.h>

#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "support/driving_node.h"
#include "support/spinner.h"
#include "support/square_drive.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

const Landmark* find(const std::vector<Landmark>& landmarks, std::uint64_t id) {
  for (const Landmark& landmark : landmarks) {
    if (landmark.id == id) return &landmark;
  }
  return nullptr;
}

TEST(MapRequestsTest, LandmarksAreRemovedAndLockedAndThatOutlivesTheNode) {
  const TemporaryFolder folder;
  const std::string path = folder / "map.bag";
  std::uint64_t id = 0;
  std::uint64_t kept = 0;
  {
    DrivingNode driving("removing");
    ASSERT_TRUE(driving.isReady());
    ASSERT_TRUE(driving.feed(0, 200));
    const auto landmarks = driving.call<GetLandmarks>("get_landmarks").landmarks;
    ASSERT_GT(landmarks.size(), 20U);
    id = landmarks[10].id;
    kept = landmarks[12].id;
    RemoveLandmark::Request remove;
    remove.id = id;
    EXPECT_TRUE(driving.call<RemoveLandmark>("remove_landmark", remove).success);
    EXPECT_NE(driving.call<RemoveLandmark>("remove_landmark", remove).message.find("no landmark"), std::string::npos);
    LockLandmark::Request lock;
    lock.id = kept;
    EXPECT_TRUE(driving.call<LockLandmark>("lock_landmark", lock).success);
    remove.id = kept;
    EXPECT_NE(driving.call<RemoveLandmark>("remove_landmark", remove).message.find("is locked"), std::string::npos);
    ASSERT_TRUE(driving.save(path).success);
  }
  DrivingNode driving("loading");
  ASSERT_TRUE(driving.isReady());
  ASSERT_TRUE(driving.load(path).success);
  ASSERT_TRUE(driving.feed(200, 700, 700));
  const auto landmarks = driving.call<GetLandmarks>("get_landmarks").landmarks;
  EXPECT_EQ(find(landmarks, id), nullptr);
  ASSERT_NE(find(landmarks, kept), nullptr);
  EXPECT_TRUE(find(landmarks, kept)->locked);
  RemoveLandmark::Request restore;
  restore.id = id;
  restore.restore = true;
  EXPECT_TRUE(driving.call<RemoveLandmark>("remove_landmark", restore).success);
  EXPECT_NE(find(driving.call<GetLandmarks>("get_landmarks").landmarks, id), nullptr);
}

TEST(MapRequestsTest, ClosuresAreAddedAndRemoved) {
  DrivingNode driving("closing", {"_close_loops:=false"});
  ASSERT_TRUE(driving.isReady());
  ASSERT_TRUE(driving.feed(0, 620));
  const std::size_t before = driving.call<GetLandmarks>("get_landmarks").landmarks.size();
  AddClosure::Request add;
  add.query_stamp = toRosTime(SquareDrive::stampAt(500));
  add.match_stamp = toRosTime(SquareDrive::stampAt(20));
  const AddClosure::Response refused = driving.call<AddClosure>("add_closure", add);
  EXPECT_FALSE(refused.success) << "no quaternion was given";
  EXPECT_NE(refused.message.find("unit norm"), std::string::npos) << refused.message;
  add.transform.pose.orientation.w = 1.0;
  const AddClosure::Response added = driving.call<AddClosure>("add_closure", add);
  ASSERT_TRUE(added.success) << added.message;
  const std::size_t merged = driving.call<GetLandmarks>("get_landmarks").landmarks.size();
  EXPECT_LT(merged, before);
  RemoveClosure::Request remove;
  remove.id = added.id;
  EXPECT_TRUE(driving.call<RemoveClosure>("remove_closure", remove).success);
  EXPECT_GE(driving.call<GetLandmarks>("get_landmarks").landmarks.size(), before);
  EXPECT_FALSE(driving.call<RemoveClosure>("remove_closure", remove).success);
}

TEST(MapRequestsTest, ResultsOfARunningNodeAreFiles) {
  const TemporaryFolder folder;
  DrivingNode driving("results");
  ASSERT_TRUE(driving.isReady());
  ASSERT_TRUE(driving.feed(0, 200));
  SaveResults::Request request;
  request.path = folder / "results";
  request.latitude = 47.0;
  request.longitude = 8.0;
  const SaveResults::Response saved = driving.call<SaveResults>("save_results", request);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(readTumTrajectory(request.path + "/trajectory.tum").size(), 200U);
  EXPECT_EQ(readKittiTrajectory(request.path + "/trajectory.txt").size(), 200U);
  EXPECT_EQ(readFile(request.path + "/landmarks.csv").rfind("id,class,x,y,z,", 0), 0U);
  EXPECT_NE(readFile(request.path + "/landmarks.geojson").find("WGS 84"), std::string::npos);
  EXPECT_TRUE(driving.call<SaveResults>("save_results", request).success) << "over its own";
  const std::string own = folder / "own";
  prepareOutputFolder(own);
  writeFileAtomically(own + "/trajectory.txt", "somebody's");
  request.path = own;
  EXPECT_FALSE(driving.call<SaveResults>("save_results", request).success);
  EXPECT_EQ(readFile(own + "/trajectory.txt"), "somebody's");
  EXPECT_FALSE(std::filesystem::exists(own + "/landmarks.csv"));
  request.latitude = 91.0;
  EXPECT_NE(driving.call<SaveResults>("save_results", request).message.find("latitude"), std::string::npos);
}

TEST(MapRequestsTest, WhoListensIsToldWhatAmbiguousDetectionsMayBe) {
  DrivingNode driving("ambiguous", {"_node/ambiguous_below:=0.9"});
  ASSERT_TRUE(driving.isReady());
  std::mutex mutex;
  std::vector<AmbiguousDetections> messages;
  const ros::Subscriber subscriber = driving.node.handle().subscribe<AmbiguousDetections>(
      "ambiguous_detections", 100,
      boost::function<void(const AmbiguousDetectionsConstPtr&)>([&](const AmbiguousDetectionsConstPtr& m) {
        const std::lock_guard<std::mutex> lock(mutex);
        messages.push_back(*m);
      }));
  ASSERT_TRUE(waitFor([&] { return subscriber.getNumPublishers() > 0; }));
  ros::WallDuration(0.5).sleep();  // the node has seen the subscriber, too
  ASSERT_TRUE(driving.feed(0, 150));
  ASSERT_TRUE(driving.call<std_srvs::Trigger>("finish_submap").success);
  ros::WallDuration(1.0).sleep();
  const std::lock_guard<std::mutex> lock(mutex);
  ASSERT_GE(messages.size(), 4U) << "one a submap of 30 m, the last by the service";
  for (std::size_t k = 0; k < messages.size(); ++k) {
    EXPECT_EQ(messages[k].submap, k);
    EXPECT_EQ(messages[k].header.frame_id, "map");
    EXPECT_GT(messages[k].detections, 100U);
    EXPECT_EQ(messages[k].below, 0.9);
    EXPECT_EQ(messages[k].items.size(), messages[k].ambiguous) << "trees that stand apart: few or none";
  }
}

}  // namespace
}  // namespace semantic_mht_slam
