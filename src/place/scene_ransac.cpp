#include <algorithm>
#include <cmath>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_registration.h>

#include "scene_correspondences.h"

namespace semantic_mht_slam {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Model = pcl::SampleConsensusModelRegistration<pcl::PointXYZ>;

constexpr int kCandidatesPerObject = 3;
constexpr int kRounds = 3;
constexpr int kIterations = 600;
constexpr double kTolerance_m = 0.8;

pcl::PointXYZ inPlane(const Eigen::Vector2d& point_m) {
  return {static_cast<float>(point_m.x()), static_cast<float>(point_m.y()), 0.0F};
}

/// The largest set of correspondences that one rigid motion of a sample explains. PCL's generator has a fixed seed.
std::vector<int> consensus(const PlanarScene& query, const PlanarScene& match,
                           const std::vector<Correspondence>& correspondences) {
  const Cloud::Ptr source(new Cloud);
  const Cloud::Ptr target(new Cloud);
  for (const Correspondence& pair : correspondences) {
    source->push_back(inPlane(query.objects[pair.query].position_m));
    target->push_back(inPlane(match.objects[pair.match].position_m));
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

std::vector<PlanarGuess> guessByRansac(const PlanarScene& query, const PlanarScene& match) {
  std::vector<Correspondence> left = findCorrespondences(query, match, kCandidatesPerObject);
  std::vector<PlanarGuess> guesses;
  for (int round = 0; round < kRounds && left.size() > 3; ++round) {
    const std::vector<int> inliers = consensus(query, match, left);
    if (inliers.size() < 3) break;
    std::vector<Correspondence> chosen;
    for (const int i : inliers) chosen.push_back(left[i]);
    guesses.push_back(motionOf(query, match, chosen));
    for (auto i = inliers.rbegin(); i != inliers.rend(); ++i) left.erase(left.begin() + *i);
  }
  return guesses;
}

}  // namespace semantic_mht_slam
