#include "semantic_mht_slam/app/system_config.h"

#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/yaml_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

TEST(SystemConfigTest, ShippedConfigurationLoadsAndItsClassTableIsFound) {
  const SystemConfig config = loadSystemConfig(packageConfigFile("kitti.yaml"), {});
  EXPECT_GT(
      loadClassTable(config, std::filesystem::path(packageConfigFile("kitti.yaml")).parent_path().string()).size(), 0);
}

TEST(SystemConfigTest, EffectiveConfigurationReadsBackAsItself) {
  SystemConfig config;
  config.slam.seed = 42;
  config.slam.input.max_odometry_gap_s = 0.125;
  config.node.map_frame = "the world's";
  const TemporaryFolder folder;
  writeFileAtomically(folder / "config.yaml", toYaml(config));
  EXPECT_EQ(toYaml(loadSystemConfig(folder / "config.yaml", {})), toYaml(config));
}

TEST(SystemConfigTest, OverridesWinOverTheFileAndBadOnesAreRefused) {
  const std::string path = packageConfigFile("kitti.yaml");
  EXPECT_EQ(loadSystemConfig(path, {parseOverride("seed=7")}).slam.seed, 7U);
  expectInputError([&] { loadSystemConfig(path, {parseOverride("sead=7")}); },
                   {"--set", "unknown key 'sead'", "'seed'"});
  expectInputError([&] { loadSystemConfig(path, {parseOverride("input.odometry_history=-1")}); }, {"out of range"});
  expectInputError([] { parseOverride("seed"); }, {"--set seed", "key=value"});
  expectInputError([] { parseOverride("=7"); }, {"key=value"});
}

TEST(SystemConfigTest, ClassTableBesideTheConfigurationComesFirst) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "mine.yaml", "classes:\n  - {id: 1, name: lamp}\n");
  SystemConfig config;
  config.class_table = "mine.yaml";
  EXPECT_EQ(loadClassTable(config, folder.path()).names(), "lamp");
  config.class_table = "none.yaml";
  expectInputError([&] { loadClassTable(config, folder.path()); }, {"none.yaml"});
}

TEST(SystemConfigTest, CommandLineMeansTheFileOfTheFolderThatOneStandsIn) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "mine.yaml", "classes:\n  - {id: 1, name: lamp}\n");
  const std::string shipped = packageConfigFile("kitti.yaml");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const SystemConfig config = loadSystemConfig(shipped, {parseOverride("class_table=mine.yaml")});
  std::filesystem::current_path(before);
  EXPECT_EQ(loadClassTable(config, std::filesystem::path(shipped).parent_path().string()).names(), "lamp");
}

TEST(SystemConfigTest, TheSubmapEvaluatorsTreeIsFoundAndAMissingOrForeignOneIsRefused) {
  SystemConfig config;
  config.slam.back_end.evaluator.check_all = false;
  EXPECT_EQ(loadableSlamConfig(config, "/").back_end.evaluator.tree, packageConfigFile("submap_evaluator.yaml"));
  EXPECT_EQ(locateEvaluatorTree(config, "/"), "submap_evaluator.yaml");
  const TemporaryFolder folder;
  writeFileAtomically(folder / "mine.yaml", readFile(packageConfigFile("submap_evaluator.yaml")));
  config.slam.back_end.evaluator.tree = "mine.yaml";
  EXPECT_EQ(loadableSlamConfig(config, folder.path()).back_end.evaluator.tree, folder / "mine.yaml");
  writeFileAtomically(folder / "foreign.yaml", "%YAML:1.0\n---\nformat: other\n");
  config.slam.back_end.evaluator.tree = "foreign.yaml";
  expectInputError([&] { loadableSlamConfig(config, folder.path()); }, {"foreign.yaml", "train_submap_evaluator"});
  config.slam.back_end.evaluator.tree = "none.yaml";
  expectInputError([&] { loadableSlamConfig(config, folder.path()); }, {"none.yaml", "cannot be read"});
  config.slam.back_end.evaluator.check_all = true;
  EXPECT_NO_THROW(loadableSlamConfig(config, folder.path()));
}

TEST(SystemConfigTest, ReferenceInTheDocumentationIsTheOneThatTheCodeMakes) {
  EXPECT_EQ(readFile(std::string(SMHT_SOURCE_DIR) + "/docs/parameters.md"), parameterReference())
      << "run: rosrun semantic_mht_slam parameter_reference > docs/parameters.md";
}

}  // namespace
}  // namespace semantic_mht_slam
