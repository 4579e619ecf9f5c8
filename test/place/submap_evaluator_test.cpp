#include "semantic_mht_slam/place/submap_evaluator.h"

#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

#include "place/submaps.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

// Submaps are good with probability 0.9 if they have more than 20 landmarks, else with 0.05.
std::vector<LabelledSubmap> makeSamples(std::uint64_t seed) {
  Rng rng(seed);
  std::vector<LabelledSubmap> samples;
  for (int i = 0; i < 1000; ++i) {
    LabelledSubmap sample;
    sample.features = {rng.uniform(6.0, 12.0), rng.uniform(0.0, 1.0), static_cast<int>(rng.index(41))};
    sample.is_good = rng.bernoulli(sample.features.landmarks > 20 ? 0.9 : 0.05);
    samples.push_back(sample);
  }
  return samples;
}

TreeTraining shallow() {
  TreeTraining training;
  training.max_depth = 1;
  return training;
}

void write(const std::string& path, const std::string& content) {
  std::ofstream(path) << content;
}

TEST(SubmapClassifierTest, LearnsTheShareOfGoodSubmapsOnBothSidesOfAThreshold) {
  const SubmapClassifier classifier = SubmapClassifier::train(makeSamples(1), shallow());
  EXPECT_NEAR(classifier.goodProb({9.0, 0.5, 30}), 0.9, 0.05);
  EXPECT_NEAR(classifier.goodProb({9.0, 0.5, 10}), 0.05, 0.05);
}

TEST(SubmapClassifierTest, ChecksWhatReachesTheThreshold) {
  SubmapClassifier classifier = SubmapClassifier::train(makeSamples(1), shallow());
  EXPECT_TRUE(classifier.isWorthChecking({9.0, 0.5, 10}));
  classifier.setMinProb(0.5);
  EXPECT_FALSE(classifier.isWorthChecking({9.0, 0.5, 10}));
  EXPECT_TRUE(classifier.isWorthChecking({9.0, 0.5, 30}));
}

TEST(SubmapClassifierTest, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  SubmapClassifier classifier = SubmapClassifier::train(makeSamples(2), TreeTraining{});
  classifier.setMinProb(0.25);
  write(folder / "tree.yaml", classifier.toYaml("a test: \"quoted\""));
  const SubmapClassifier read = SubmapClassifier::load(folder / "tree.yaml");
  EXPECT_EQ(read.minProb(), 0.25);
  for (const LabelledSubmap& sample : makeSamples(3)) {
    EXPECT_EQ(read.goodProb(sample.features), classifier.goodProb(sample.features));
  }
}

TEST(SubmapClassifierTest, TheSameSamplesGiveTheSameFile) {
  const auto yaml = [] { return SubmapClassifier::train(makeSamples(4), TreeTraining{}).toYaml("x"); };
  EXPECT_EQ(yaml(), yaml());
}

TEST(SubmapClassifierTest, SamplesOfOneKindThrow) {
  auto samples = makeSamples(5);
  for (LabelledSubmap& sample : samples) sample.is_good = true;
  EXPECT_THROW(SubmapClassifier::train(samples, TreeTraining{}), std::invalid_argument);
  EXPECT_THROW(SubmapClassifier::train({}, TreeTraining{}), std::invalid_argument);
}

TEST(SubmapClassifierTest, UnusableFilesGiveAnErrorThatNamesThem) {
  const TemporaryFolder folder;
  const std::string path = folder / "tree.yaml";
  expectInputError([&] { SubmapClassifier::load(path); }, {path, "cannot be read"});
  expectInputError([&] { SubmapClassifier::load(folder.path()); }, {folder.path(), "cannot be read"});
  const std::string good = SubmapClassifier::train(makeSamples(6), TreeTraining{}).toYaml("x");
  const std::vector<std::string> bad = {"",
                                        "no yaml at all",
                                        "key: value\n",
                                        "%YAML:1.0\n---\nkey: value\n",
                                        "%YAML:1.0\n---\n- 1\n- 2\n",
                                        "%YAML:1.0\n---\n o:e\nd  -\nf\n",  // OpenCV would read it for ever
                                        "%YAML:1.\n format: x\nd  -\nf",
                                        "{\"format\": 1}",
                                        good.substr(0, good.size() / 2),
                                        good.substr(0, good.find("tree:")),
                                        good.substr(0, good.find("   nodes:"))};
  for (const std::string& content : bad) {
    write(path, content);
    expectInputError([&] { SubmapClassifier::load(path); }, {path});
  }
}

TEST(SubmapClassifierTest, FilesWithOtherFeaturesNumbersOrTreesAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "tree.yaml";
  const std::string good = SubmapClassifier::train(makeSamples(6), TreeTraining{}).toYaml("x");
  const auto expectRefused = [&](const std::string& from, const std::string& to, const std::string& reason) {
    std::string content = good;
    const std::size_t position = content.find(from);
    ASSERT_NE(position, std::string::npos) << from << " is not in\n" << good;
    write(path, content.replace(position, from.size(), to));
    expectInputError([&] { SubmapClassifier::load(path); }, {path, reason});
  };
  expectRefused("tf_idf", "colour", "features");
  expectRefused("min_prob: 0.", "min_prob: 2.", "min_prob");
  expectRefused("min_prob: 0.", "min_prob: many", "min_prob");
  expectRefused("var:", "var: 7", "");
  expectRefused("value: ", "value: 3", "damaged");
  expectRefused("var_type: [ 0, 0, 0, 0 ]", "var_type: [ ]", "damaged");
  expectRefused("var_all: 4", "var_all: 2147483647", "damaged");
  expectRefused("var_count: 3", "count: 3", "damaged");
  expectRefused("is_classifier: 0", "is_classifier: 1", "damaged");
  expectRefused("var_type: [ 0, 0, 0, 0 ]", "var_type: [ 0, 0, 0, 1 ]", "damaged");
  expectRefused("var_type: [ 0, 0, 0, 0 ]", "var_type: 5", "damaged");
  expectRefused("var:", "var:9, other:", "damaged");
  expectRefused("var_idx: [ 0, 1, 2 ]", "var_idx: [ 0, 1, -1000000000 ]", "damaged");
  expectRefused("value: ", ": ", "not a tree");
}

TEST(SubmapEvaluatorTest, WithoutATreeChecksEverySubmapThatHasLandmarks) {
  SubmapEvaluatorConfig config;
  config.check_all = true;
  SubmapEvaluator evaluator = makeSubmapEvaluator(config, "/no/such/file", 2);
  EXPECT_TRUE(evaluator.add(makeSubmap({0}, 2)).worth_checking);
  EXPECT_FALSE(evaluator.add(Submap{}).worth_checking);
}

TEST(SubmapEvaluatorTest, WithATreeChecksWhatItFindsWorthIt) {
  SubmapClassifier classifier = SubmapClassifier::train(makeSamples(1), shallow());
  classifier.setMinProb(0.5);
  SubmapEvaluator evaluator(2, std::move(classifier));
  const SubmapEvaluation few = evaluator.add(makeSubmap({0, 1, 0}, 2));
  EXPECT_FALSE(few.worth_checking);
  EXPECT_EQ(few.features->landmarks, 3);
  const SubmapEvaluation many = evaluator.add(makeSubmap(std::vector<ClassIndex>(35, 1), 2));
  EXPECT_TRUE(many.worth_checking);
  EXPECT_GT(many.good_prob, few.good_prob);
}

TEST(SubmapEvaluatorTest, AMissingTreeIsAnErrorUnlessEverySubmapIsChecked) {
  SubmapEvaluatorConfig config;
  config.check_all = false;
  expectInputError([&] { makeSubmapEvaluator(config, "/no/such/file", 2); }, {"/no/such/file"});
  config.check_all = true;
  EXPECT_NO_THROW(makeSubmapEvaluator(config, "/no/such/file", 2));
}

}  // namespace
}  // namespace semantic_mht_slam
