#include "semantic_mht_slam/mapping/association.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mapping/association_test_util.h"

namespace semantic_mht_slam {
namespace {

using namespace association_test;  // NOLINT(google-build-using-namespace): the world of these tests

int bestColumn(const AssociationProblem& problem, int measurement) {
  int best = -1;
  double cost = 1e300;
  for (int e = problem.costs.rowBegin(measurement); e < problem.costs.rowEnd(measurement); ++e) {
    if (problem.costs.cost(e) < cost) {
      cost = problem.costs.cost(e);
      best = problem.costs.column(e);
    }
  }
  return best;
}

TEST(AssociationTest, PoissonPriorFallsWithTheMeanWhenNothingComes) {
  MapperConfig few = makePaperConfig();
  MapperConfig many = makePaperConfig();
  few.association.new_density = 0.1;
  many.association.new_density = 5.0;
  const ClassTable table = makeTable();
  EXPECT_NEAR(AssociationModel(few, table).logAssignmentPrior(0, 0, 0) -
                  AssociationModel(many, table).logAssignmentPrior(0, 0, 0),
              4.9, 1e-12)
      << "exp(-lambda V), not exp(+lambda V)";
}

TEST(AssociationTest, AssignmentPriorEqualsItsFormula) {
  MapperConfig config = makePaperConfig();
  config.association.new_density = 2.0;
  config.association.false_positive_density = 0.5;
  const double expected =
      std::log(2.0 * 6.0 / 5040.0) + std::log(std::exp(-2.0) * 4.0 / 2.0) + std::log(std::exp(-0.5) * 0.125 / 6.0);
  EXPECT_NEAR(AssociationModel(config, makeTable()).logAssignmentPrior(2, 3, 7), expected, 1e-12);
}

TEST(AssociationTest, AHundredSightingsNeitherOverflowNorCaptureADetectionFourteenSigmaAway) {
  for (const CountPrior prior : {CountPrior::kLinear, CountPrior::kExponential}) {
    MapperConfig config = makePaperConfig();
    config.association.count_prior = prior;
    const AssociationModel model(config, makeTable());
    MapHypothesis hypothesis;
    hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 100000), makeLandmark(2, 2.2, 0, 1)};
    const double sigma = std::sqrt(0.02);
    AssociationProblem problem;
    model.formulate(hypothesis, {makeMeasurement(14.0 * sigma, 0)}, 0.0, problem);
    for (const double cost : problem.costs.costs()) EXPECT_TRUE(std::isfinite(cost));
    EXPECT_EQ(bestColumn(problem, 0), 1);
  }
}

TEST(AssociationTest, ManySightingsDoNotCaptureADetectionThatFitsAnotherLandmark) {
  MapperConfig config = makePaperConfig();
  const AssociationModel model(config, makeTable());
  const double sigma = std::sqrt(0.02);
  AssociationProblem problem;
  MapHypothesis hypothesis;
  hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 100000), makeLandmark(2, 3.5 * sigma, 0, 1)};
  model.formulate(hypothesis, {makeMeasurement(3.5 * sigma, 0)}, 0.0, problem);
  ASSERT_EQ(problem.gated[0].size(), 2U);
  EXPECT_EQ(bestColumn(problem, 0), 1);
  // log 20 against the misfit of 3.5 deviations
  EXPECT_NEAR(problem.costs.cost(0) - problem.costs.cost(1), 0.5 * 3.5 * 3.5 - std::log(20.0), 1e-9);
}

TEST(AssociationTest, FalsePositivesAreExpectedAtTheRateSoFar) {
  const MapperConfig config = makePaperConfig();
  const AssociationModel model(config, makeTable());
  AssociationProblem problem;
  const auto falseCost = [&](int false_positives) {
    MapHypothesis hypothesis;
    hypothesis.false_positives = false_positives;
    model.formulate(hypothesis, {makeMeasurement(0.0, 0)}, 0.0, problem);
    return problem.costs.cost(problem.costs.rowEnd(0) - 1);
  };
  const double log_uniform = -std::log(config.association.map_volume_m3) - std::log(3.0);
  EXPECT_NEAR(falseCost(7), -std::log(7.0 * config.association.false_positive_rate) - log_uniform, 1e-9);
  EXPECT_NEAR(falseCost(0),
              -std::log(config.association.concentration * config.association.false_positive_rate) - log_uniform, 1e-9);
}

TEST(AssociationTest, OutliersAreAMixtureOfTwoGaussians) {
  MapperConfig config = makePaperConfig();
  config.association.outlier_prob = 0.2;
  const AssociationModel model(config, makeTable());
  MapHypothesis hypothesis;
  hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 1)};
  for (const double x_m : {0.0, 0.35, 0.5, 1.0}) {
    Measurement measurement = makeMeasurement(x_m, 0);
    measurement.outlier_cov_m2 = 0.18 * Eigen::Matrix3d::Identity();
    AssociationProblem problem;
    model.formulate(hypothesis, {measurement}, 0.0, problem);
    const auto density = [&](double variance_m2) {
      return std::exp(-0.5 * x_m * x_m / variance_m2) / std::pow(2.0 * M_PI * variance_m2, 1.5);
    };
    ASSERT_EQ(problem.gated[0].size(), 1U);
    const Candidate& candidate = problem.gated[0][0];
    EXPECT_NEAR(candidate.log_likelihood, std::log(0.8 * density(0.02) + 0.2 * density(0.2)), 1e-9) << x_m;
    EXPECT_NEAR(candidate.log_part_likelihood, std::log(density(0.2)), 1e-9) << x_m;
    EXPECT_EQ(candidate.is_outlier, 0.2 * density(0.2) > 0.8 * density(0.02)) << x_m;
  }
}

TEST(AssociationTest, LandmarksOfWanderingCentroidsGrowWithTheDistanceSinceTheyWereSeen) {
  const AssociationModel model(makePaperConfig(), makeTable());
  auto landmark = std::make_shared<TrackedLandmark>(*makeLandmark(1, 0.0, 0, 5));
  landmark->updated_at_m = 2.0;
  MapHypothesis hypothesis;
  hypothesis.landmarks = {{landmark, {}}};
  Measurement measurement = makeMeasurement(1.0, 0);
  measurement.wander_variance_per_m = 0.05;
  AssociationProblem problem;
  model.formulate(hypothesis, {measurement}, 2.0, problem);
  EXPECT_TRUE(problem.gated[0].empty());
  model.formulate(hypothesis, {measurement}, 6.0, problem);
  ASSERT_EQ(problem.gated[0].size(), 1U);
  const Eigen::Vector3d variance_m2(0.02 + 4.0 * 0.05, 0.02 + 4.0 * 0.05, 0.02);
  const double log_det = variance_m2.array().log().sum();
  EXPECT_NEAR(problem.gated[0][0].log_likelihood, -0.5 * (1.0 / variance_m2.x() + log_det + 3.0 * std::log(2.0 * M_PI)),
              1e-9);
}

TEST(AssociationTest, UnderTheDeltaModelAnotherClassIsNeverTheSameLandmark) {
  const AssociationModel model(makePaperConfig(), makeTable());
  MapHypothesis hypothesis;
  hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 10)};
  AssociationProblem problem;
  model.formulate(hypothesis, {makeMeasurement(0.0, 1), makeMeasurement(0.0, 0)}, 0.0, problem);
  EXPECT_EQ(problem.gated[0].size(), 0U);
  EXPECT_EQ(problem.gated[1].size(), 1U);
}

TEST(AssociationTest, UnderTheConfusionModelItIsPossibleAndWithoutSemanticsEqual) {
  MapperConfig config = makePaperConfig();
  config.association.class_model = ClassModel::kConfusion;
  MapHypothesis hypothesis;
  hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 10)};
  AssociationProblem problem;
  AssociationModel(config, makeTable())
      .formulate(hypothesis, {makeMeasurement(0.0, 1), makeMeasurement(0.0, 0)}, 0.0, problem);
  ASSERT_EQ(problem.gated[0].size(), 1U);
  EXPECT_LT(problem.gated[0][0].log_likelihood, problem.gated[1][0].log_likelihood);
  config.semantics = false;
  AssociationModel(config, makeTable())
      .formulate(hypothesis, {makeMeasurement(0.0, 1), makeMeasurement(0.0, 0)}, 0.0, problem);
  EXPECT_EQ(problem.gated[0][0].log_likelihood, problem.gated[1][0].log_likelihood);
}

TEST(AssociationTest, AFalsePositiveIsUnlikelyWhereALandmarkExplainsTheMeasurement) {
  MapperConfig config = makePaperConfig();
  config.association.false_positive_rate = 1.0;
  const AssociationModel model(config, makeTable());
  MapHypothesis hypothesis;
  hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 1)};
  AssociationProblem problem;
  model.formulate(hypothesis, {makeMeasurement(0.0, 0), makeMeasurement(30.0, 0)}, 0.0, problem);
  const auto falseCost = [&](int row) { return problem.costs.cost(problem.costs.rowEnd(row) - 1); };
  EXPECT_GT(falseCost(0), falseCost(1) + 5.0);
}

TEST(AssociationTest, GaussianTransitionsWidenLandmarksOfEarlierSubmapsOnly) {
  const AssociationModel model(makePaperConfig(), makeTable());
  auto earlier = std::make_shared<TrackedLandmark>(*makeLandmark(1, 0.0, 2, 5));
  earlier->is_from_earlier_submap = true;
  MapHypothesis now;
  now.landmarks = {makeLandmark(1, 0.0, 2, 5)};
  MapHypothesis before;
  before.landmarks = {{earlier, {}}};
  AssociationProblem problem;
  model.formulate(now, {makeMeasurement(3.0, 2)}, 0.0, problem);
  EXPECT_TRUE(problem.gated[0].empty());
  model.formulate(before, {makeMeasurement(3.0, 2)}, 0.0, problem);
  EXPECT_EQ(problem.gated[0].size(), 1U);
}

TEST(AssociationTest, WithoutSemanticsTheNumberOfClassesDoesNotTipTheBalance) {
  MapperConfig config = makePaperConfig();
  config.semantics = false;
  std::vector<double> differences;
  for (const std::size_t count : {1U, 3U}) {
    std::vector<ClassInfo> classes = makeTable().all();
    classes.resize(count);
    MapHypothesis hypothesis;
    hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 1)};
    AssociationProblem problem;
    AssociationModel(config, ClassTable(classes, "test"))
        .formulate(hypothesis, {makeMeasurement(0.1, 0)}, 0.0, problem);
    differences.push_back(problem.costs.cost(1) - problem.costs.cost(0));
  }
  EXPECT_NEAR(differences[0], differences[1], 1e-12);
}

TEST(AssociationTest, TheUkfBaselineTakesDistancesToLandmarksOfItsClassWithinItsGate) {
  MapperConfig config = defaultsOf(Estimator::kUkf);
  MapHypothesis hypothesis;
  hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 1), makeLandmark(2, 0.3, 1, 1), makeLandmark(3, 1.5, 0, 1),
                          makeLandmark(4, 2.5, 0, 1)};
  AssociationProblem problem;
  const std::vector<Measurement> measurements = {makeMeasurement(0.4, 0)};
  AssociationModel(config, makeTable()).formulate(hypothesis, measurements, 0.0, problem);
  EXPECT_EQ(problem.costs.columnIndices(), (std::vector<int>{0, 2, 4}));
  EXPECT_NEAR(problem.costs.cost(0), 0.4, 1e-12);
  EXPECT_NEAR(problem.costs.cost(1), 1.1, 1e-12);
  EXPECT_NEAR(problem.costs.cost(2), config.association.ukf_gate_m, 1e-12);
  config.semantics = false;
  AssociationModel(config, makeTable()).formulate(hypothesis, measurements, 0.0, problem);
  EXPECT_EQ(problem.costs.columnIndices(), (std::vector<int>{0, 1, 2, 4}));
}

}  // namespace
}  // namespace semantic_mht_slam
