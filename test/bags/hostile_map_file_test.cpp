// Map files of this program's format with right digests and one value changed: each kind that once killed, hung or
// bloated the node is refused by the names of file and section.
#include <filesystem>

#include <gtest/gtest.h>

#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/map/map_state.h"

#include "support/expect_input_error.h"
#include "support/graph_section.h"
#include "support/peak_memory.h"
#include "support/square_drive.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

constexpr int kDriven = 560;  // more than a round: with loop closures
constexpr int kNowhere = 100000000;
constexpr char kEndsTooEarly[] = "it ends too early";

class HostileMapFileTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Slam slam(SystemConfig().slam, makeStreetClasses());
    SquareDrive(7).feed(slam, 0, kDriven);
    slam.finish();
    good_ = new SavedMap(mapOf(slam));
  }
  static void TearDownTestSuite() { delete good_; }

  static GraphSection goodGraph() {
    SlamState state = good_->state;
    return GraphSection(sectionOf(state, "graph"));
  }

  void load() {
    const LoadedMap loaded = readMapFile(path_, config_, classes_, [] { return true; });
    Slam(config_.slam, classes_, loaded.state);
  }

  /// The file with a section's bytes.
  void write(const std::string& section, const std::string& bytes) {
    SavedMap map = *good_;
    sectionOf(map.state, section) = bytes;
    writeMapFile(path_, map, config_, classes_);
  }

  void expectRefused(const std::string& section, const std::string& bytes, const std::string& reason) {
    write(section, bytes);
    expectInputError([&] { load(); }, {path_, "section '" + section + "'", reason});
  }

  template <class Change>
  void expectGraphRefused(const Change& change, const std::string& reason) {
    GraphSection graph = goodGraph();
    change(graph);
    write("graph", graph.bytes());
    try {
      load();
      ADD_FAILURE() << "a graph that is broken was taken";
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("section 'graph': broken state: " + reason), std::string::npos) << what;
      EXPECT_EQ(what.find(kEndsTooEarly), std::string::npos) << what;
    }
  }

  /// Refused, and no more memory taken than the bar.
  void expectRefusedCheaply(const std::string& section, const std::string& bytes) {
    write(section, bytes);
    PeakMemory memory;
    const bool is_measured = memory.begin();
    expectInputError([&] { load(); }, {path_});
    const double file_mb = 1e-6 * static_cast<double>(std::filesystem::file_size(path_));
    if (!is_measured) return;
    EXPECT_LE(memory.grown_mb(), 3.0 * file_mb + 50.0) << "of a file of " << file_mb << " MB";
  }

  static SavedMap* good_;
  TemporaryFolder folder_;
  const std::string path_ = folder_ / "map.bag";
  const SystemConfig config_{};
  const ClassTable classes_ = makeStreetClasses();
};

SavedMap* HostileMapFileTest::good_ = nullptr;

/// So what is refused below is refused for what was changed.
TEST_F(HostileMapFileTest, OfAnUnchangedGraphOnlyWhatFollowsIsMissing) {
  const GraphSection graph = goodGraph();
  ASSERT_FALSE(graph.loops.empty());
  ASSERT_FALSE(graph.links.empty());
  ASSERT_FALSE(graph.loop_links.empty());
  ASSERT_FALSE(graph.group_of.empty());
  expectRefused("graph", graph.bytes(), kEndsTooEarly);
}

TEST_F(HostileMapFileTest, NumbersOfPartsThatThereAreNotAreRefused) {
  for (const int number : {kNowhere, -1}) {
    expectGraphRefused([&](GraphSection& graph) { graph.loop_links.front().link = number; }, "");
    expectGraphRefused([&](GraphSection& graph) { graph.active.back() = number; }, "");
    expectGraphRefused([&](GraphSection& graph) { graph.links.back().to = number; }, "");
    expectGraphRefused([&](GraphSection& graph) { graph.loops.front().from = number; }, "");
    expectGraphRefused([&](GraphSection& graph) { graph.nodes.back().loops.push_back(number); }, "");
    expectGraphRefused([&](GraphSection& graph) { graph.landmarks.begin()->second.anchor = number; }, "");
    expectGraphRefused([&](GraphSection& graph) { graph.landmarks.begin()->second.sightings.back().node = number; },
                       "");
    expectGraphRefused([&](GraphSection& graph) { graph.touched.insert(number); }, "");
    expectGraphRefused([&](GraphSection& graph) { graph.in_hierarchy = number; }, "");
  }
}

TEST_F(HostileMapFileTest, LandmarksThatAreKeptAsEachOtherAreRefused) {
  const auto swap = [](GraphSection& graph) {
    const auto a = graph.landmarks.begin();
    const auto b = std::next(a);
    graph.group_of[a->first] = b->first;
    graph.group_of[b->first] = a->first;
    for (auto& sighting : a->second.sightings) sighting.landmark = b->first;
    for (auto& sighting : b->second.sightings) sighting.landmark = a->first;
  };
  expectGraphRefused(swap, "landmarks that are kept as each other, in a circle");
}

/// Names of one landmark in a circle are that landmark, once.
TEST_F(HostileMapFileTest, DuplicatesInACircleAreOneLandmark) {
  SlamState state = good_->state;
  std::vector<Submap> submaps;
  StateArchive reading(sectionOf(state, "submaps"));
  reading(submaps);
  reading.requireEnd();
  const std::vector<MixtureLandmark>& landmarks = submaps.front().landmarks;
  ASSERT_GE(landmarks.size(), 3U);
  const LandmarkId a = landmarks[0].id;
  const LandmarkId b = landmarks[1].id;
  const LandmarkId c = landmarks[2].id;
  submaps.front().duplicates = {{a, b}, {b, a}, {b, c}, {c, a}, {a, a}};
  StateArchive writing;
  writing(submaps);
  write("submaps", writing.written());
  const LoadedMap loaded = readMapFile(path_, config_, classes_, [] { return true; });
  Slam slam(config_.slam, classes_, loaded.state);
  SquareDrive(7).feed(slam, kDriven, kDriven + 100);
  slam.finish();
  EXPECT_FALSE(landmarksOf(slam).empty());
}

TEST_F(HostileMapFileTest, ShortFilesThatMakeMuchAreRefusedBeforeMemoryIsTaken) {
  GraphSection graph = goodGraph();
  graph.agrees.assign(4U << 20U, {});  // a byte each in the file, 40 in memory
  expectRefusedCheaply("graph", graph.bytes());

  StateArchive zeros;  // matrices of which three bytes are left
  constexpr int kMatrices = 200;
  zeros.count<Eigen::MatrixXd>(kMatrices);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2000, 2000);
  for (int i = 0; i < kMatrices; ++i) zeros(matrix);
  expectRefusedCheaply("submaps", zeros.written());

  SlamState state = good_->state;
  std::string& submaps = sectionOf(state, "submaps");
  std::string counts;
  for (int i = 0; i < 5; ++i) counts += static_cast<char>(0xFF);
  expectRefusedCheaply("submaps", counts + '\x01' + submaps + std::string(7U << 20U, '\0'));
  for (const StateSection& section : good_->state.sections) {
    expectRefusedCheaply(section.name, std::string(7U << 20U, '\0'));
    expectRefusedCheaply(section.name, std::string(7U << 20U, '\x02'));
    expectRefusedCheaply(section.name, "\xFF\xFF\xFF\x02" + std::string(8U << 20U, '\0'));
  }
}

TEST_F(HostileMapFileTest, WhatIsMadeOfAStateTakesNoMoreThanItMay) {
  SavedMap map = *good_;
  map.state.most_memory = 1U << 20U;
  expectInputError([&] { Slam(config_.slam, classes_, map.state); }, {"section '", "more memory than"});
}

}  // namespace
}  // namespace semantic_mht_slam
