#include <cmath>
#include <set>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

#include "mapping/association_test_util.h"

namespace semantic_mht_slam {
namespace {

using namespace association_test;  // NOLINT(google-build-using-namespace): the world of these tests

TEST(AssociationGateTest, TheGateLetsItsShareOfTrueAssociationsThrough) {
  for (const double share : {0.9, 0.99, 0.999}) {
    MapperConfig config = makePaperConfig();
    config.association.gate_prob = share;
    const AssociationModel model(config, makeTable());
    MapHypothesis hypothesis;
    hypothesis.landmarks = {makeLandmark(1, 0.0, 0, 1)};
    Rng rng(1);
    std::vector<Measurement> measurements;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      measurements.push_back(makeMeasurement(0.0, 0));
      measurements.back().position_m = std::sqrt(0.02) * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
    }
    AssociationProblem problem;
    model.formulate(hypothesis, measurements, 0.0, problem);
    int inside = 0;
    for (const auto& candidates : problem.gated) inside += static_cast<int>(candidates.size());
    const double stddev = std::sqrt(share * (1.0 - share) / kSamples);
    EXPECT_NEAR(static_cast<double>(inside) / kSamples, share, 4.0 * stddev);
  }
}

TEST(AssociationGateTest, CandidatesAreJustTheLandmarksInsideTheGate) {
  MapperConfig config = makePaperConfig();
  Rng rng(1);
  const auto uniform3 = [&](double side_m) -> Eigen::Vector3d {
    return {rng.uniform(0.0, side_m), rng.uniform(0.0, side_m), rng.uniform(0.0, 1.0)};
  };
  for (const double outlier_prob : {0.0, 0.1}) {
    config.association.outlier_prob = outlier_prob;
    const AssociationModel model(config, makeTable());
    MapHypothesis hypothesis;
    for (LandmarkId id = 1; id <= 80; ++id) {
      auto landmark = std::make_shared<TrackedLandmark>(*makeLandmark(id, 0.0, 0, 1));
      const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return rng.normal(0.0, 0.5); });
      landmark->position = {uniform3(20.0), root * root.transpose() + 0.01 * Eigen::Matrix3d::Identity()};
      hypothesis.landmarks.push_back({landmark, {}});
    }
    std::vector<Measurement> measurements;
    for (int i = 0; i < 40; ++i) {
      measurements.push_back(makeMeasurement(0.0, 0));
      measurements.back().position_m = uniform3(20.0);
      measurements.back().outlier_cov_m2.diagonal() = uniform3(0.5);
    }
    AssociationProblem problem;
    model.formulate(hypothesis, measurements, 0.0, problem);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      std::set<int> expected;
      std::set<int> found;
      for (const Candidate& candidate : problem.gated[i]) found.insert(candidate.landmark);
      for (std::size_t j = 0; j < hypothesis.landmarks.size(); ++j) {
        const Gaussian3& landmark = hypothesis.landmarks[j]->position;
        const Eigen::Vector3d d = measurements[i].position_m - landmark.mean_m;
        Eigen::Matrix3d cov = landmark.cov_m2 + measurements[i].cov_m2;
        if (outlier_prob > 0.0) cov += measurements[i].outlier_cov_m2;
        const bool is_near = d.head<2>().cwiseAbs().maxCoeff() <= config.association.max_gate_m;
        if (is_near && d.dot(cov.inverse() * d) <= 16.266) expected.insert(static_cast<int>(j));  // chi^2_3 of 0.999
      }
      EXPECT_EQ(found, expected);
      inside += expected.size();
    }
    EXPECT_GT(inside, 50U);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
