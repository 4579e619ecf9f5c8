#include <algorithm>
#include <cmath>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_registration.h>

#include "correspondences.h"
#include "first_guesses.h"

namespace semantic_mht_slam {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Model = pcl::SampleConsensusModelRegistration<pcl::PointXYZ>;

constexpr int kRansacCandidates = 3;
constexpr int kRounds = 3;
constexpr int kIterations = 600;
constexpr double kTolerance_m = 0.8;

pcl::PointXYZ inPlane(const Eigen::Vector3d& point_m) {
  return {static_cast<float>(point_m.x()), static_cast<float>(point_m.y()), 0.0F};
}

/// The largest set of correspondences that one rigid motion of a sample explains. PCL's generator has a fixed seed.
std::vector<int> consensus(const RegistrationProblem& problem, const std::vector<Correspondence>& correspondences) {
  const Cloud::Ptr source(new Cloud);
  const Cloud::Ptr target(new Cloud);
  for (const Correspondence& pair : correspondences) {
    source->push_back(inPlane(problem.detections[pair.detection].position_m));
    target->push_back(inPlane(problem.landmarks[pair.landmark].position_m));
  }
  const Model::Ptr model(new Model(source));
  model->setInputTarget(target);
  pcl::RandomSampleConsensus<pcl::PointXYZ> ransac(model, kTolerance_m);
  ransac.setMaxIterations(kIterations);
  std::vector<int> inliers;
  if (ransac.computeModel()) ransac.getInliers(inliers);
  std::sort(inliers.begin(), inliers.end());
  return inliers;
}

}  // namespace

std::vector<PlanarState> guessByRansac(const RegistrationProblem& problem) {
  std::vector<Correspondence> left = findCorrespondences(problem, kRansacCandidates);
  std::vector<PlanarState> guesses;
  for (int round = 0; round < kRounds && left.size() > 3; ++round) {
    const std::vector<int> inliers = consensus(problem, left);
    if (inliers.size() < 3) break;
    std::vector<Correspondence> chosen;
    for (const int i : inliers) chosen.push_back(left[i]);
    guesses.push_back(motionOf(problem, chosen));
    for (auto i = inliers.rbegin(); i != inliers.rend(); ++i) left.erase(left.begin() + *i);
  }
  return guesses;
}

}  // namespace semantic_mht_slam
