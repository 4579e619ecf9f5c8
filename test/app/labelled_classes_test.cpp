#include "semantic_mht_slam/app/labelled_classes.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/io/label_map_file.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

constexpr char kTable[] = "classes:\n  - {id: 3, name: pole}\n  - {id: 4, name: car}\n";

std::string nameOf(const LabelledClasses& labelled, std::uint16_t id) {
  const ClassIndex index = labelled.labels.classOf(id);
  if (index == LabelMap::kIgnored) return "ignored";
  return index == LabelMap::kUnknown ? "unknown" : labelled.classes[index].name;
}

TEST(LabelledClassesTest, ShippedMapsNameTheClassesOfTheirIds) {
  const LabelledClasses raw = loadLabelledClasses("labels_semantic_kitti.yaml");
  EXPECT_EQ(nameOf(raw, 10), "vehicle");
  EXPECT_EQ(nameOf(raw, 80), "pole");
  EXPECT_EQ(nameOf(raw, 252), "vehicle");
  EXPECT_TRUE(raw.labels.isMoving(252));
  EXPECT_FALSE(raw.labels.isMoving(10));
  EXPECT_EQ(nameOf(raw, 40), "ignored");
  EXPECT_EQ(nameOf(raw, 12), "unknown");
  const LabelledClasses train = loadLabelledClasses("labels_semantic_kitti_train.yaml");
  EXPECT_EQ(nameOf(train, 17), "pole");
  EXPECT_EQ(nameOf(train, 18), "traffic_sign");
  EXPECT_EQ(nameOf(train, 8), "ignored");
  const LabelledClasses cityscapes = loadLabelledClasses("labels_cityscapes.yaml");
  EXPECT_EQ(nameOf(cityscapes, 5), "pole");
  EXPECT_EQ(nameOf(cityscapes, 13), "vehicle");
  EXPECT_EQ(nameOf(cityscapes, 255), "ignored");
}

TEST(LabelledClassesTest, AShippedTableBringsItsMap) {
  const LabelledClasses labelled = loadLabelledClasses(packageConfigFile("classes_semantic_kitti.yaml"));
  EXPECT_EQ(nameOf(labelled, 252), "vehicle");
  EXPECT_EQ(nameOf(labelled, 12), "unknown");
}

TEST(LabelledClassesTest, ATableWithoutAMapStandsForItsOwnIds) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "mine.yaml", kTable);
  const LabelledClasses labelled = loadLabelledClasses(folder / "mine.yaml");
  EXPECT_EQ(nameOf(labelled, 3), "pole");
  EXPECT_EQ(nameOf(labelled, 4), "car");
  EXPECT_EQ(nameOf(labelled, 5), "ignored");
}

class LabelMapFileTest : public ::testing::Test {
 protected:
  LabelMapFileTest() { writeFileAtomically(folder_ / "table.yaml", kTable); }

  LabelledClasses load(const std::string& map) const {
    writeFileAtomically(folder_ / "map.yaml", map);
    return loadLabelledClasses(folder_ / "map.yaml");
  }

  const TemporaryFolder folder_;
};

TEST_F(LabelMapFileTest, IdsAreMappedMovingAndIgnoredAsWritten) {
  const LabelledClasses labelled =
      load("class_table: table.yaml\nlabels: {7: pole, 8: car}\nmoving: {9: car}\nignored: [0, 65535]\n");
  EXPECT_EQ(nameOf(labelled, 7), "pole");
  EXPECT_EQ(nameOf(labelled, 9), "car");
  EXPECT_TRUE(labelled.labels.isMoving(9));
  EXPECT_EQ(nameOf(labelled, 65535), "ignored");
  EXPECT_EQ(nameOf(labelled, 3), "unknown");
}

TEST_F(LabelMapFileTest, EveryProblemIsNamedWithItsLine) {
  const std::string head = "class_table: table.yaml\n";
  expectInputError([&] { load(head + "labels:\n  7: tree\n  x: pole\n  70000: pole\nextra: 1\n"); },
                   {"map.yaml:3", "unknown class 'tree'", "map.yaml:4", "map.yaml:5", "unknown key 'extra'"});
  expectInputError([&] { load(head + "labels: {7: pole}\nignored: [7]\n"); }, {"label id 7", "twice"});
  expectInputError([&] { load(head + "labels: [7]\n"); }, {"'labels'"});
  expectInputError([&] { load(head + "labels: {7: pole}\nignored: 7\n"); }, {"'ignored'"});
  expectInputError([&] { load("labels: {7: pole}\n"); }, {"class_table"});
  expectInputError([&] { load(head + "labels: {7: [pole]}\n"); }, {"map.yaml:2"});
  expectInputError([&] { loadLabelledClasses(folder_ / "no.yaml"); }, {"no.yaml"});
}

}  // namespace
}  // namespace semantic_mht_slam
