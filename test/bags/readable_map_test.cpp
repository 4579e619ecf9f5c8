#include "semantic_mht_slam/bags/readable_map.h"

#include <functional>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <semantic_mht_slam/MapUpdate.h>

#include "semantic_mht_slam/merging/map_merger.h"

#include "support/expect_input_error.h"
#include "support/square_drive.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

/// A map of 640 m that was kept when the messages of a map's finished part were written for the first time, with
/// sections that nobody can read. It must stay readable: never replace it by a newer one.
const std::string kKeptFile = SMHT_SOURCE_DIR "/test/bags/kept/square.bag";

/// Map files with sections of another version, as another version of the program writes them.
class ReadableMapTest : public testing::Test {
 protected:
  ReadableMapTest() : classes_(makeStreetClasses()), slam_(config_.slam, classes_) {
    SquareDrive(3).feed(slam_, 0, 640);
    slam_.finish();
    map_ = mapOf(slam_);
    for (StateSection& section : map_.state.sections) section = {section.name, 0, "of another program"};
    writeMapFile(path_, map_, config_, classes_);
  }

  LoadedMap read(const std::string& path) const {
    return readMapFile(path, config_, classes_, [] { return true; });
  }

  /// The file with its updates changed.
  std::string withUpdates(const std::function<bool(MapUpdate&)>& change) const {
    const std::string path = folder_ / "changed.bag";
    rosbag::Bag bag(path_, rosbag::bagmode::Read);
    rosbag::Bag changed(path, rosbag::bagmode::Write);
    rosbag::View view(bag);
    for (const rosbag::MessageInstance& instance : view) {
      const auto update = instance.instantiate<MapUpdate>();
      if (update == nullptr) {
        changed.write(instance.getTopic(), instance.getTime(), instance);
      } else if (change(*update)) {
        changed.write(instance.getTopic(), instance.getTime(), *update);
      }
    }
    return path;
  }

  /// Another drive through the same square, whose odometry begins anew.
  void driveAgain(Slam& slam, int begin, int end) const {
    const SquareDrive square(3);
    for (int i = begin; i < end; ++i) {
      slam.addOdometry({SquareDrive::stampAt(i), SquareDrive::odometryAt(i - 100)});
      slam.addDetections(SquareDrive::stampAt(i) - 30000000, square.detectionsAt(i - 100));
    }
  }

  const SystemConfig config_;
  const ClassTable classes_;
  Slam slam_;
  SavedMap map_;
  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "map.bag";
};

void expectSquare(const Slam& slam, std::size_t landmarks) {
  EXPECT_GT(slam.map().submaps().size(), 15U);
  EXPECT_NEAR(static_cast<double>(landmarksOf(slam).size()), static_cast<double>(landmarks),
              0.03 * static_cast<double>(landmarks));
  const SquareDrive square(3);
  for (const StampedPose& pose : trajectoryOf(slam)) {
    const int frame = static_cast<int>(pose.stamp / SquareDrive::stampAt(0)) - 1;
    const Eigen::Vector3d apart_m = pose.T_world_base.translation_m - square.truthAt(frame).translation_m;
    EXPECT_LT(apart_m.norm(), 2.0) << frame;  // what the map itself may be off
  }
}

TEST_F(ReadableMapTest, AMapOfAnotherVersionIsMadeOfItsFinishedSubmaps) {
  const LoadedMap loaded = read(path_);
  EXPECT_NE(loaded.remade.find("has version 0, this program reads version"), std::string::npos) << loaded.remade;
  EXPECT_EQ(loaded.finished.deltas.size(), slam_.map().submaps().size());
  const Slam again(config_.slam, classes_, stateOf(loaded, config_.slam, classes_));
  EXPECT_EQ(again.map().keyframes().size(), slam_.map().keyframes().size());
  expectSquare(again, landmarksOf(slam_).size());
}

TEST_F(ReadableMapTest, ItCanBeGoneOnIn) {
  Slam slam(config_.slam, classes_, stateOf(read(path_), config_.slam, classes_));
  const std::size_t submaps = slam.map().submaps().size();
  const std::size_t landmarks = landmarksOf(slam).size();
  driveAgain(slam, 1100, 1400);
  slam.finish();
  EXPECT_GT(slam.map().submaps().size(), submaps + 5);
  EXPECT_LT(landmarksOf(slam).size(), landmarks + landmarks / 4) << "what was known is not mapped twice";
}

TEST_F(ReadableMapTest, AVehicleFindsItselfInIt) {
  Slam slam(config_.slam, classes_, stateOf(read(path_), config_.slam, classes_));
  slam.localize();
  slam.beginSession();
  driveAgain(slam, 1100, 1250);
  ASSERT_TRUE(isLocated(slam.mode()));
  const Pose truth = SquareDrive(3).truthAt(1149);
  EXPECT_LT((latestPoseOf(slam)->T_world_base.translation_m - truth.translation_m).norm(), 1.0);
}

TEST_F(ReadableMapTest, TheKeptFileIsReadMergedAndLocalizedIn) {
  Slam kept(config_.slam, classes_, stateOf(read(kKeptFile), config_.slam, classes_));
  expectSquare(kept, landmarksOf(slam_).size());
  Slam other(config_.slam, classes_);
  driveAgain(other, 800, 1200);
  other.finish();
  std::vector<MergeMap> maps{MergeMap("kept", kept), MergeMap("other", other)};
  const MergeResult result = mergeMaps(maps, config_.slam, classes_);
  EXPECT_TRUE(result.pairs[0].is_joined) << result.pairs[0].reason;
  kept.localize();
  kept.beginSession();
  driveAgain(kept, 1100, 1250);
  EXPECT_TRUE(isLocated(kept.mode()));
}

TEST_F(ReadableMapTest, WithoutMessagesTheVersionIsRefused) {
  const std::string bare = withUpdates([](MapUpdate&) { return false; });
  const LoadedMap loaded = read(bare);
  EXPECT_TRUE(loaded.remade.empty());
  expectInputError([&] { Slam(config_.slam, classes_, stateOf(loaded, config_.slam, classes_)); },
                   {bare, "has version 0, this program reads version"});
}

TEST_F(ReadableMapTest, HostileMessagesAreRefused) {
  const std::string missing = withUpdates([](MapUpdate& update) { return update.number != 3; });
  expectInputError([&] { read(missing); }, {missing, "another version", "field 'number'"});
  const std::uint32_t newest = static_cast<std::uint32_t>(slam_.map().submaps().size() - 1);
  const std::string cut = withUpdates([&](MapUpdate& update) { return update.number != newest; });
  expectInputError([&] { read(cut); }, {cut, "field 'closures_held'"});
  const std::string bad = withUpdates([](MapUpdate& update) { return update.driven = -1.0, true; });
  expectInputError([&] { read(bad); }, {bad, "field 'driven'"});
  const std::string crossed = withUpdates([](MapUpdate& update) {
    update.driven = 1000.0 - update.number;
    return true;
  });
  expectInputError([&] { stateOf(read(crossed), config_.slam, classes_); }, {crossed, "order of the drive"});
  const std::string hungry = withUpdates([](MapUpdate& update) {
    update.keyframes.resize(4000);
    update.shown.assign(((1 + update.keyframes.size()) * update.landmarks.size() + 7) / 8, 0xff);
    return true;
  });
  expectInputError([&] { read(hungry); }, {hungry, "more content than there can be"});
}

}  // namespace
}  // namespace semantic_mht_slam
