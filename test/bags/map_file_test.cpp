#include "semantic_mht_slam/bags/map_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Time.h>
#include <sys/stat.h>

#include <semantic_mht_slam/MapHeader.h>
#include <semantic_mht_slam/MapSection.h>
#include <semantic_mht_slam/SemanticMap.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/square_drive.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const KeepReading kAlways = [] { return true; };

/// A map file of a short drive.
class MapFileTest : public testing::Test {
 protected:
  MapFileTest() : classes_(makeStreetClasses()), slam_(config_.slam, classes_) {
    SquareDrive(1).feed(slam_, 0, 150);
    map_ = mapOf(slam_);
    writeMapFile(path_, map_, config_, classes_);
  }

  LoadedMap read(const std::string& path) const { return readMapFile(path, config_, classes_, kAlways); }

  /// Writes the file again with its header changed.
  std::string withHeader(const std::function<void(MapHeader&)>& change) const {
    const std::string path = folder_ / "changed.bag";
    rosbag::Bag bag(path_, rosbag::bagmode::Read);
    rosbag::Bag changed(path, rosbag::bagmode::Write);
    rosbag::View view(bag);
    for (const rosbag::MessageInstance& instance : view) {
      if (const auto header = instance.instantiate<MapHeader>()) {
        change(*header);
        changed.write(instance.getTopic(), instance.getTime(), *header);
      } else {
        changed.write(instance.getTopic(), instance.getTime(), instance);
      }
    }
    return path;
  }

  /// Content of the file, whose first chunk claims to hold 4 GB.
  std::string withLargeChunk() const {
    std::string content = readFile(path_);
    const std::size_t size = content.find("size=", content.find("compression=bz2"));
    EXPECT_NE(size, std::string::npos);
    return size == std::string::npos ? content : content.replace(size + 5, 4, "\x00\x00\x00\xF0", 4);
  }

  TemporaryFolder folder_;
  std::string path_ = folder_ / "map.bag";
  SystemConfig config_;
  ClassTable classes_;
  Slam slam_;
  SavedMap map_;
};

TEST_F(MapFileTest, WhatWasWrittenIsReadToTheLastBit) {
  const LoadedMap loaded = read(path_);
  ASSERT_EQ(loaded.state.sections.size(), map_.state.sections.size());
  for (std::size_t i = 0; i < loaded.state.sections.size(); ++i) {
    EXPECT_EQ(loaded.state.sections[i].name, map_.state.sections[i].name);
    EXPECT_TRUE(loaded.state.sections[i].bytes == map_.state.sections[i].bytes) << loaded.state.sections[i].name;
  }
  EXPECT_EQ(loaded.submaps, slam_.map().submaps().size());
  EXPECT_EQ(loaded.landmarks, landmarksOf(slam_).size());
  EXPECT_TRUE(loaded.has_same_parameters);
}

TEST_F(MapFileTest, LargeSectionsComeBackAndAreNeverReadInOnePiece) {
  SavedMap map = map_;
  map.state.sections.push_back({"large", 3, std::string((5U << 20U) + 7U, ' ')});
  Rng rng(1);
  for (char& byte : map.state.sections.back().bytes) byte = static_cast<char>(rng.bits());
  map.state.sections.push_back({"empty", 1, ""});
  writeMapFile(path_, map, config_, classes_);
  const LoadedMap loaded = read(path_);
  ASSERT_EQ(loaded.state.sections.size(), map.state.sections.size());
  const StateSection& large = loaded.state.sections[map.state.sections.size() - 2];
  EXPECT_TRUE(large.bytes == map.state.sections[map.state.sections.size() - 2].bytes);
  EXPECT_EQ(large.version, 3);
  EXPECT_EQ(loaded.state.sections.back().name, "empty");
  int asked = 0;
  readMapFile(path_, config_, classes_, [&] { return ++asked > 0; });
  EXPECT_GE(asked, 13) << "the header, five small sections, six pieces, the empty one";
}

TEST_F(MapFileTest, LandmarksAndTrajectoryCanBeReadWithoutTheState) {
  rosbag::Bag bag(path_, rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{"/map"}));
  ASSERT_EQ(view.size(), 1U);
  const auto map = view.begin()->instantiate<SemanticMap>();
  ASSERT_NE(map, nullptr);
  const auto landmarks = landmarksOf(slam_);
  ASSERT_EQ(map->landmarks.size(), landmarks.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    EXPECT_EQ(map->landmarks[i].id, landmarks[i].id);
    EXPECT_NEAR(map->landmarks[i].position.x, landmarks[i].position.mean_m.x(), 6e-4);
    EXPECT_NEAR(map->landmarks[i].covariance[8] / landmarks[i].position.cov_m2(2, 2), 1.0, 2e-4);
  }
}

TEST_F(MapFileTest, OtherParametersAreAllowedAndTold) {
  SystemConfig other = config_;
  other.slam.mapper.tree.max_hypotheses = 7;
  const LoadedMap loaded = readMapFile(path_, other, classes_, kAlways);
  EXPECT_FALSE(loaded.has_same_parameters);
  EXPECT_NO_THROW(Slam(other.slam, classes_, loaded.state));
}

TEST_F(MapFileTest, TruncatedFilesAreRefusedWhereverTheyEnd) {
  const std::string content = readFile(path_);
  const std::string cut = folder_ / "cut.bag";
  for (int i = 0; i < 60; ++i) {
    const std::size_t length = i < 20 ? static_cast<std::size_t>(i) : content.size() * (i - 19) / 41;
    writeFileAtomically(cut, content.substr(0, length));
    expectInputError([&] { read(cut); }, {cut, "truncated"});
  }
  writeFileAtomically(cut, content.substr(0, content.size() - 1));
  expectInputError([&] { read(cut); }, {cut});
}

TEST_F(MapFileTest, ForeignFilesAreRefused) {
  expectInputError([&] { read(folder_ / "nothing.bag"); }, {"no such file"});
  expectInputError([&] { read(folder_.path()); }, {"no such file, or no regular one"});
  const std::string text = folder_ / "text.bag";
  writeFileAtomically(text, "a text that is no bag at all\n");
  expectInputError([&] { read(text); }, {text, "no map file"});
  const std::string pipe = folder_ / "pipe.bag";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expectInputError([&] { read(pipe); }, {"no regular one"});
  const std::string other = folder_ / "other.bag";
  {
    rosbag::Bag bag(other, rosbag::bagmode::Write);
    bag.write("/time_origin", ros::Time(1.0), std_msgs::Time());
  }
  expectInputError([&] { read(other); }, {other, "is no map file", "/map_header"});
  {
    rosbag::Bag bag(other, rosbag::bagmode::Write);
    bag.write("/map_header", ros::Time(1.0), std_msgs::Time());
  }
  expectInputError([&] { read(other); }, {"/map_header holds std_msgs/Time"});
}

TEST_F(MapFileTest, NewerFilesAreRefused) {
  const std::string newer = withHeader([](MapHeader& header) { ++header.format_version; });
  expectInputError([&] { read(newer); }, {newer, "made by a newer program: format 3, this one reads up to 2"});
}

TEST_F(MapFileTest, MissingSectionsAreNamed) {
  const std::string more = withHeader([](MapHeader& header) { header.sections.push_back("weather"); });
  expectInputError([&] { read(more); }, {"section 'weather' is missing"});
}

TEST_F(MapFileTest, AnotherClassTableOrMethodIsRefused) {
  expectInputError([&] { readMapFile(path_, config_, makeStreetClasses("fence"), kAlways); },
                   {"another class table", "'trunk'", "'fence'"});
  SystemConfig other = config_;
  other.slam.method = Method::kUkf;
  expectInputError([&] { readMapFile(path_, other, classes_, kAlways); }, {"'dpmhm'", "'ukf'"});
}

TEST_F(MapFileTest, ReadingStopsWhenItIsNotWantedAnyMore) {
  expectInputError([&] { readMapFile(path_, config_, classes_, [] { return false; }); }, {"given up"});
}

TEST_F(MapFileTest, DamageIsRefusedOrWithoutEffect) {
  const std::string content = readFile(path_);
  const std::string damaged = folder_ / "damaged.bag";
  Rng rng(2);
  int refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::string bytes = content;
    bytes[rng.index(bytes.size())] ^= static_cast<char>(1U << rng.index(8));
    std::ofstream(damaged, std::ios::binary) << bytes;
    try {
      const LoadedMap loaded = read(damaged);
      for (const StateSection& section : map_.state.sections) {
        const auto is_it = [&](const StateSection& other) { return other.name == section.name; };
        const auto found = std::find_if(loaded.state.sections.begin(), loaded.state.sections.end(), is_it);
        ASSERT_NE(found, loaded.state.sections.end()) << trial << section.name;
        EXPECT_TRUE(found->bytes == section.bytes) << trial << section.name;  // in whatever order they stand
      }
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(MapFileTest, AnIndexThatLeadsToNoMessageIsRefused) {
  const std::string content = readFile(path_);
  const std::string damaged = folder_ / "damaged.bag";
  const std::string begin = std::string("op=\x04") + std::string({4 + 4, 0, 0, 0}) + "ver=";
  int entries = 0;
  for (std::size_t at = content.find(begin); at != std::string::npos; at = content.find(begin, at + 1)) {
    const std::size_t offset = at + begin.size() + 4 + 4 + 8;  // behind version, length of the data, time
    for (const int bit : {0, 5, 13, 31}) {
      std::string bytes = content;
      bytes.at(offset + static_cast<std::size_t>(bit / 8)) ^= static_cast<char>(1U << (bit % 8));
      std::ofstream(damaged, std::ios::binary) << bytes;
      expectInputError([&] { read(damaged); }, {damaged, "its index leads to no message"});
    }
    ++entries;
  }
  EXPECT_GT(entries, 1);
}

TEST_F(MapFileTest, AChunkThatClaimsMoreThanThereCanBeIsRefusedBeforeMemoryIsTaken) {
  const std::string hungry = folder_ / "hungry.bag";
  writeFileAtomically(hungry, withLargeChunk());
  expectInputError([&] { read(hungry); }, {hungry, "a chunk claims more"});
}

TEST_F(MapFileTest, SectionsOfMoreBytesThanThereCanBeAreRefused) {
  SavedMap map = map_;
  for (int i = 0; i < 100; ++i) map.state.sections.push_back({"zeros", 1, std::string(1U << 20U, '\0')});
  writeMapFile(path_, map, config_, classes_);
  expectInputError([&] { read(path_); }, {"section 'zeros' holds more"});
}

TEST_F(MapFileTest, AChangedNumberWithTheRightDigestIsRefusedByTheNameOfItsSection) {
  SavedMap map = map_;
  for (StateSection& section : map.state.sections) {
    const std::string good = section.bytes;
    section.bytes.back() = static_cast<char>(section.bytes.back() ^ 0x55);
    section.bytes += "x";
    writeMapFile(path_, map, config_, classes_);
    expectInputError([&] { Slam(config_.slam, classes_, read(path_).state); },
                     {path_, "section '" + section.name + "'"});
    section.bytes = good;
  }
}

TEST_F(MapFileTest, OnlyMapsAreReplaced) {
  const std::string other = folder_ / "other.bag";
  writeFileAtomically(other, "somebody's text");
  expectInputError([&] { writeMapFile(other, map_, config_, classes_); }, {other, "no map is there, and stays"});
  EXPECT_EQ(readFile(other), "somebody's text");
  std::filesystem::remove(other);
  {
    rosbag::Bag bag(other, rosbag::bagmode::Write);
    bag.write("/time_origin", ros::Time(1.0), std_msgs::Time());
  }
  expectInputError([&] { writeMapFile(other, map_, config_, classes_); }, {other, "no map is there, and stays"});
  {
    rosbag::Bag bag(other, rosbag::bagmode::Write);
    bag.write("/map_header", ros::Time(1.0), std_msgs::Time());
  }
  expectInputError([&] { writeMapFile(other, map_, config_, classes_); }, {other, "no map is there, and stays"});
  const std::string hungry = folder_ / "hungry.bag";
  writeFileAtomically(hungry, withLargeChunk());
  expectInputError([&] { writeMapFile(hungry, map_, config_, classes_); }, {hungry, "no map is there, and stays"});
  writeFileAtomically(other, "");
  for (const std::string& path : {other, path_}) {
    const std::size_t bytes = writeMapFile(path, map_, config_, classes_);
    EXPECT_EQ(bytes, std::filesystem::file_size(path)) << path;
  }
}

TEST_F(MapFileTest, FailedWritesLeaveTheOldFileAlone) {
  const std::string content = readFile(path_);
  expectInputError([&] { writeMapFile(folder_.path(), map_, config_, classes_); }, {"cannot write"});
  expectInputError([&] { writeMapFile(folder_ / "no/such/folder/map.bag", map_, config_, classes_); },
                   {"cannot write"});
  EXPECT_TRUE(readFile(path_) == content);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1) << "no temporary file is left";
}

}  // namespace
}  // namespace semantic_mht_slam
