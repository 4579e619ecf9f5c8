#include <filesystem>
#include <fstream>
#include <future>

#include <gtest/gtest.h>

#include "semantic_mht_slam/bags/map_file.h"

#include "support/running_map_server.h"
#include "support/spinner.h"
#include "support/square_drive.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

/// The map of a drive through the square of `world` whose odometry begins at another place than the square's; with a
/// noise of its own.
class DrivenMap {
 public:
  DrivenMap(std::uint64_t world, int begin, int end) : square_(world), begin_(begin) {
    Slam slam(config_.slam, classes_);
    for (int i = begin; i < end; ++i) {
      slam.addOdometry({SquareDrive::stampAt(i), T_odom_square() * SquareDrive::odometryAt(i)});
      Detections detections = square_.detectionsAt(i);
      for (Detection& detection : detections) detection.class_index += 4;  // trunks and poles of the default table
      slam.addDetections(SquareDrive::stampAt(i) - 30000000, detections);
    }
    slam.finish();
    map_ = mapOf(slam);
  }

  void write(const std::string& path) const { writeMapFile(path, map_, config_, classes_); }

  std::size_t landmarks() const { return map_.landmarks.size(); }

  /// Where its own frame lies in the square, up to what odometry has drifted until its first frame.
  Pose T_square_map() const {
    const Pose T_map_base = T_odom_square() * SquareDrive::odometryAt(begin_);
    return square_.truthAt(begin_) * T_map_base.inverse();
  }

 private:
  Pose T_odom_square() const {
    return {expRotation({0.0, 0.0, 0.3 + 0.01 * begin_}), {40.0, -7.0 - 0.5 * begin_, 0.0}};
  }

  const SystemConfig config_;
  const ClassTable classes_ = loadClassTable(config_, "");
  SquareDrive square_;
  int begin_;
  SavedMap map_;
};

constexpr int kJoined = MapStatus::JOINED;
constexpr int kApart = MapStatus::APART;
constexpr int kRemoved = MapStatus::REMOVED;
constexpr int kUnusable = MapStatus::UNUSABLE;

/// Two drives through one square, and one through another.
struct Drives {
  DrivenMap first{7, 0, 400};
  DrivenMap second{7, 680, 1100};
  DrivenMap stranger{8, 0, 400};
};

const Drives& drives() {
  static const Drives drives;
  return drives;
}

/// A server that begins with the files a.bag and b.bag of the two drives that belong together.
struct TwoMaps {
  explicit TwoMaps(const std::string& name) {
    drives().first.write(folder / "a.bag");
    drives().second.write(folder / "b.bag");
    const std::vector<std::string> parameters{"_server/maps:=" + folder / "a.bag" + ":" + folder / "b.bag"};
    server = std::make_unique<RunningServer>(name, parameters);
  }

  TemporaryFolder folder;
  std::unique_ptr<RunningServer> server;
};

TEST(MapServerTest, MapsOfAFolderBecomeOneAsTheyCome) {
  const TemporaryFolder folder;
  drives().first.write(folder / "first.bag");
  RunningServer server("folder", {"_server/folder:=" + folder.path()});
  ASSERT_TRUE(server.comesTo({{"first", kJoined}}));
  EXPECT_TRUE(server.comesToShowLandmarks(drives().first.landmarks()));

  drives().second.write(folder / "second.bag");
  ASSERT_TRUE(server.comesTo({{"first", kJoined}, {"second", kJoined}}));
  const MergeStatus status = server.status();
  ASSERT_EQ(status.pairs.size(), 1U);
  EXPECT_TRUE(status.pairs[0].joined);
  EXPECT_GT(status.pairs[0].posterior, 0.999);
  EXPECT_GT(status.pairs[0].closures, 10U);
  EXPECT_TRUE(server.comesToShowLandmarks(status.landmarks));
  EXPECT_LT(server.landmarks(), drives().first.landmarks() + drives().second.landmarks() / 2) << "each object once";
  EXPECT_TRUE(server.draws("first") && server.draws("second"));
  ASSERT_TRUE(waitFor([&] { return server.transform("first") && server.transform("second"); }));
  const Pose T_first_second = server.transform("first")->inverse() * *server.transform("second");
  const Pose true_pose = drives().first.T_square_map().inverse() * drives().second.T_square_map();
  const Pose error = true_pose.inverse() * T_first_second;
  EXPECT_LT(logRotation(error.rotation).norm(), 0.05);

  drives().stranger.write(folder / "third.bag");
  ASSERT_TRUE(server.comesTo({{"first", kJoined}, {"second", kJoined}, {"third", kApart}}));
  EXPECT_FALSE(server.map("third").reason.empty());
  EXPECT_TRUE(waitFor([&] { return server.diagnosis().find("2 of 3 maps are in one: third: ") == 0; }))
      << server.diagnosis();

  drives().second.write(folder / "third.bag");
  ASSERT_TRUE(server.comesTo({{"first", kJoined}, {"second", kJoined}, {"third", kJoined}})) << "the file has changed";
}

TEST(MapServerTest, RemovedAndForgottenMapsLeaveTheWorld) {
  const TwoMaps maps("services");
  const TemporaryFolder& folder = maps.folder;
  RunningServer& server = *maps.server;
  ASSERT_TRUE(server.comesTo({{"a", kJoined}, {"b", kJoined}}));
  const std::size_t of_both = server.status().landmarks;

  EXPECT_TRUE(server.remove("b").success);
  ASSERT_TRUE(server.comesTo({{"a", kJoined}, {"b", kRemoved}}));
  EXPECT_TRUE(server.comesToShowLandmarks(drives().first.landmarks()));
  EXPECT_NE(server.remove("b").message.find("removed already"), std::string::npos);
  EXPECT_TRUE(server.add("", "b").success);
  ASSERT_TRUE(server.comesTo({{"a", kJoined}, {"b", kJoined}}));
  EXPECT_TRUE(server.comesToShowLandmarks(of_both));

  EXPECT_TRUE(server.remove("b", "forget_map").success);
  ASSERT_TRUE(server.comesTo({{"a", kJoined}}));
  const AddMap::Response unknown = server.add("", "b");
  EXPECT_FALSE(unknown.success);
  EXPECT_EQ(unknown.message, "there is no map 'b'; there are: a");
  const AddMap::Response added = server.add(folder / "b.bag", "robot-2");
  EXPECT_TRUE(added.success);
  EXPECT_EQ(added.message, "robot-2");
  ASSERT_TRUE(server.comesTo({{"a", kJoined}, {"robot-2", kJoined}}));
}

TEST(MapServerTest, SavedWorldIsAMapFile) {
  const TwoMaps maps("saving");
  const TemporaryFolder& folder = maps.folder;
  RunningServer& server = *maps.server;
  ASSERT_TRUE(server.comesTo({{"a", kJoined}, {"b", kJoined}}));
  SaveMap::Request request;
  request.path = folder / "all.bag";
  const SaveMap::Response saved = server.call<SaveMap>("save_map", request);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.bytes, fs::file_size(folder / "all.bag"));
  const SystemConfig config;
  const LoadedMap map = readMapFile(folder / "all.bag", config, loadClassTable(config, ""), [] { return true; });
  EXPECT_EQ(map.landmarks, server.status().landmarks);
}

TEST(MapServerTest, WhatCannotBeUsedIsNamedAndTheRestGoesOn) {
  const TemporaryFolder folder;
  drives().first.write(folder / "good.bag");
  std::ofstream(folder / "bad.bag") << "no bag";
  std::ofstream(folder / "notes.txt") << "no map";
  RunningServer server("trouble", {"_server/folder:=" + folder.path()});
  ASSERT_TRUE(server.comesTo({{"bad", kUnusable}, {"good", kJoined}}));
  EXPECT_NE(server.map("bad").reason.find("no map file at all"), std::string::npos);
  EXPECT_TRUE(waitFor([&] { return server.diagnosis().find("bad.bag") != std::string::npos; })) << server.diagnosis();
  const AddMap::Response missing = server.add(folder / "missing.bag");
  EXPECT_FALSE(missing.success);
  EXPECT_NE(missing.message.find("No such file"), std::string::npos) << missing.message;
  EXPECT_FALSE(server.add(folder / "good.bag", "a/b").success) << "no name";
  fs::remove(folder / "bad.bag");
  ASSERT_TRUE(server.comesTo({{"good", kJoined}})) << "it is gone";
  fs::create_symlink("loop.bag", folder / "loop.bag");
  drives().second.write(folder / "bad.bag");
  ASSERT_TRUE(server.comesTo({{"bad", kJoined}, {"good", kJoined}, {"loop", kUnusable}})) << "mended";
  const std::size_t landmarks = server.status().landmarks;
  std::ofstream(folder / "bad.bag", std::ios::trunc) << "no bag any more";
  EXPECT_TRUE(waitFor([&] { return server.map("bad").reason.find("what it was stays") != std::string::npos; }));
  EXPECT_EQ(server.status().landmarks, landmarks);
}

TEST(MapServerTest, OneFileIsOneMap) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "maps");
  drives().first.write(folder / "maps/a.bag");
  fs::create_symlink(folder / "maps", folder / "link");
  RunningServer server("once", {"_server/folder:=" + folder / "link", "_server/maps:=" + folder / "maps/a.bag"});
  ASSERT_TRUE(server.comesTo({{"a", kJoined}}));
  EXPECT_TRUE(server.add(folder / "link/a.bag").success) << "read again";
  const AddMap::Response again = server.add(folder / "link/a.bag", "b");
  EXPECT_FALSE(again.success);
  EXPECT_NE(again.message.find("is here already, as 'a'"), std::string::npos) << again.message;
  drives().second.write(folder / "b.bag");
  EXPECT_FALSE(server.add(folder / "b.bag", "a").success) << "another map has the name";
  SaveMap::Request request;
  request.path = folder / "link/world.bag";
  const SaveMap::Response own = server.call<SaveMap>("save_map", request);
  EXPECT_FALSE(own.success);
  EXPECT_NE(own.message.find("the folder whose maps are joined"), std::string::npos) << own.message;
}

TEST(MapServerTest, ASavedWorldIsThatOfTheCallsBefore) {
  const TwoMaps maps("at_once");
  const TemporaryFolder& folder = maps.folder;
  RunningServer& server = *maps.server;
  ASSERT_TRUE(server.comesTo({{"a", kJoined}, {"b", kJoined}}));
  SaveMap::Request request;
  request.path = folder / "all.bag";
  EXPECT_TRUE(server.remove("b").success);
  EXPECT_EQ(server.call<SaveMap>("save_map", request).message.find(std::to_string(drives().first.landmarks()) + " "),
            0U);
}

TEST(MapServerTest, BagsAreReadAndWrittenByTwoThreads) {
  const TemporaryFolder folder;
  drives().first.write(folder / "a.bag");
  RunningServer server("busy", {"_server/maps:=" + folder / "a.bag"});
  ASSERT_TRUE(server.comesTo({{"a", kJoined}}));
  auto adding = std::async(std::launch::async, [&] {
    for (int i = 0; i < 25; ++i) EXPECT_TRUE(server.add(folder / "a.bag").success);
  });
  SaveMap::Request request;
  request.path = folder / "world.bag";
  for (int i = 0; i < 25; ++i) EXPECT_TRUE(server.call<SaveMap>("save_map", request).success) << i;
  adding.get();
}

TEST(MapServerTest, ItDoesNotBeginWithWhatCannotBeUsed) {
  for (const char* parameter : {"_server/maps:=/nowhere/map.bag", "_server/folder:=/nowhere", "_server/map:=/a.bag"}) {
    RosProcess process("map_server", {"__name:=unusable", parameter});
    EXPECT_TRUE(waitFor([&] { return process.stop(0, 0.0) >= 0.0; })) << parameter;
    EXPECT_EQ(process.exitCode(), 1) << parameter;
  }
}

TEST(MapServerTest, InterruptEndsIt) {
  const TemporaryFolder folder;
  drives().first.write(folder / "a.bag");
  RunningServer server("ending", {"_server/folder:=" + folder.path()});
  ASSERT_TRUE(server.comesTo({{"a", kJoined}}));
  EXPECT_GE(server.process().stop(SIGINT, 5.0), 0.0);
  EXPECT_EQ(server.process().exitCode(), 0);
}

}  // namespace
}  // namespace semantic_mht_slam
