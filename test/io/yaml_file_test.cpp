#include "semantic_mht_slam/io/yaml_file.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

class YamlFileTest : public ::testing::Test {
 protected:
  std::string write(const std::string& content) {
    writeFileAtomically(folder_ / "a.yaml", content);
    return folder_ / "a.yaml";
  }

  const TemporaryFolder folder_;
};

TEST_F(YamlFileTest, NestedKeysAreJoinedByDotsAndKnowTheirLine) {
  const auto settings = readSettings(write("# comment\nseed: 3\ninput:\n  gap: 0.5\n  deep: {x: true}\n"));
  ASSERT_EQ(settings.size(), 3U);
  EXPECT_EQ(settings[1].key, "input.gap");
  EXPECT_EQ(settings[1].value, "0.5");
  EXPECT_EQ(settings[1].origin, folder_ / "a.yaml" + ":4");
  EXPECT_EQ(settings[2].key, "input.deep.x");
  EXPECT_TRUE(readSettings(write("")).empty());
}

TEST_F(YamlFileTest, WhatIsNoMapOfScalarsIsRefused) {
  expectInputError([&] { readSettings(write("a: [1, 2]\n")); }, {"a.yaml:1", "'a'"});
  expectInputError([&] { readSettings(write("- 1\n")); }, {"a.yaml:1"});
  expectInputError([&] { readSettings(write("a: 1\nb: {\n")); }, {"a.yaml:", "not YAML"});
  expectInputError([&] { readSettings(write("a: 1\na: 2\n")); }, {"a.yaml:2", "'a' stands twice"});
  expectInputError([&] { readSettings(write("a: &x\n  b: *x\n")); }, {"a.yaml", "nested"});
  expectInputError([&] { readSettings(write("{a: b}: 1\n")); }, {"a.yaml:1", "key"});
  expectInputError([&] { readSettings(write("a: 1\n---\nb: 2\n")); }, {"a.yaml", "more than one"});
  expectInputError([&] { readSettings(folder_ / "none.yaml"); }, {"none.yaml"});
}

TEST_F(YamlFileTest, WhatTheParserNeverEndsWithIsRefused) {
  for (const char* content : {",", "]", "}", ",,,", "a: 1\n---\n,", ", a"}) {
    expectInputError([&] { readSettings(write(content)); }, {"a.yaml"});
    expectInputError([&] { readClassTable(write(content)); }, {"a.yaml"});
  }
  std::string doubling = "a0: &a0 {x: 1, y: 2}\n";
  for (int i = 1; i < 19; ++i) {
    const std::string name = "*a" + std::to_string(i - 1);
    doubling += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " {p: " + name + ", q: " + name +
                ", r: " + name + ", s: " + name + "}\n";
  }
  expectInputError([&] { readSettings(write(doubling)); }, {"a.yaml", "too many values"});
}

TEST_F(YamlFileTest, ShippedClassTablesAreReadable) {
  const std::string config = std::string(SMHT_SOURCE_DIR) + "/config/";
  const ClassTable kitti = readClassTable(config + "classes_semantic_kitti.yaml");
  for (const char* name : {"vehicle", "building", "fence", "vegetation", "trunk", "pole", "traffic_sign"}) {
    EXPECT_TRUE(kitti.findName(name)) << name;
  }
  EXPECT_FALSE(kitti[*kitti.findName("vehicle")].is_static);
  EXPECT_TRUE(readClassTable(config + "classes_cityscapes.yaml").findId(13));
}

TEST_F(YamlFileTest, ClassTableReportsTheProblemsOfAllEntries) {
  expectInputError([&] { readClassTable(write("classes:\n  - {id: x, name: a}\n  - {ID: 1, name: b}\n")); },
                   {"a.yaml:2", "id = 'x'", "a.yaml:3", "unknown key 'ID'"});
  expectInputError([&] { readClassTable(write("classes: 3\n")); }, {"a.yaml", "classes"});
}

}  // namespace
}  // namespace semantic_mht_slam
