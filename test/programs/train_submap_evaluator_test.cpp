#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

ProgramResult train(const std::string& arguments) {
  return runProgramOfPackage("train_submap_evaluator", arguments);
}

std::string shortScenario() {
  return "--scenario '" + std::string(SMHT_SOURCE_DIR) + "/config/scenarios/short.yaml' ";
}

std::string shippedTree() {
  return std::string(SMHT_SOURCE_DIR) + "/config/submap_evaluator.yaml";
}

std::string contentOf(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path).rdbuf();
  return content.str();
}

TEST(TrainSubmapEvaluatorTest, WritesATreeThatNamesItsTrainingDrivesAndCanBeTested) {
  const TemporaryFolder folder;
  const std::string tree = folder / "tree.yaml";
  const auto trained = train(shortScenario() + "--seeds 1-3 --output " + tree);
  ASSERT_EQ(trained.exit_code, 0) << trained.output;
  for (const std::string part : {"trained on simulated short, seeds 1-3", "cross-validated: precision 0.", "recall"}) {
    EXPECT_NE(trained.output.find(part), std::string::npos) << trained.output;
  }
  EXPECT_NE(contentOf(tree).find("simulated short, seeds 1-3"), std::string::npos);
  const auto tested = train(shortScenario() + "--seeds 4 --test " + tree);
  EXPECT_EQ(tested.exit_code, 0);
  EXPECT_NE(tested.output.find("tested on simulated short, seeds 4"), std::string::npos) << tested.output;
}

TEST(TrainSubmapEvaluatorTest, TheSameDrivesGiveTheSameTree) {
  const TemporaryFolder folder;
  ASSERT_EQ(train(shortScenario() + "--seeds 1-2 --output " + (folder / "a.yaml")).exit_code, 0);
  ASSERT_EQ(train(shortScenario() + "--seeds 1-2 --output " + (folder / "b.yaml")).exit_code, 0);
  EXPECT_EQ(contentOf(folder / "a.yaml"), contentOf(folder / "b.yaml"));
}

TEST(TrainSubmapEvaluatorTest, TheShippedTreeCanBeReadAndNamesItsTrainingDrives) {
  EXPECT_NE(contentOf(shippedTree()).find("trained_on: \"simulated "), std::string::npos);
  const auto tested = train(shortScenario() + "--seeds 1 --test " + shippedTree());
  EXPECT_EQ(tested.exit_code, 0) << tested.output;
}

TEST(TrainSubmapEvaluatorTest, BadInputEndsWithCodeOneAndAMessageAndWritesNothing) {
  const TemporaryFolder folder;
  const std::string output = " --output " + (folder / "tree.yaml");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {shortScenario(), "--output and --test"},
      {output, "--scenario or --dataset"},
      {shortScenario() + "--seeds five" + output, "--seeds five"},
      {shortScenario() + "--seeds 3-1" + output, "--seeds 3-1"},
      {shortScenario() + "--seeds 1 " + output, "at least two drives"},
      {shortScenario() + "--recall 2" + output, "--recall"},
      {shortScenario() + "--max-depth 0" + output, "--max-depth"},
      {shortScenario() + "--min-samples 1" + output, "--min-samples"},
      {"--scenario /no/such.yaml" + output, "/no/such.yaml"},
      {"--dataset /no/such" + output, "/no/such"},
      {shortScenario() + "--test /no/such/tree.yaml", "/no/such/tree.yaml"},
      {shortScenario() + "--test " + std::string(SMHT_SOURCE_DIR) + "/config/kitti.yaml", "kitti.yaml"},
      {shortScenario() + "--output " + folder.path(), folder.path()},
  };
  for (const auto& [arguments, message] : cases) {
    const auto result = train(arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments << "\n" << result.output;
    EXPECT_NE(result.output.find("train_submap_evaluator: "), std::string::npos) << result.output;
    EXPECT_NE(result.output.find(message), std::string::npos) << arguments << "\n" << result.output;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace semantic_mht_slam
