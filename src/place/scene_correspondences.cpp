#include "scene_correspondences.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "semantic_mht_slam/common/max_clique.h"

#include "scene_fit.h"

namespace semantic_mht_slam {
namespace {

constexpr double kSignatureRadius_m = 30.0;
constexpr double kSignatureBin_m = 2.0;
constexpr int kSignatureBins = 15;
constexpr int kCandidatesPerObject = 4;
constexpr int kMaxCliques = 3;
constexpr double kMinDistance_m = 1.0;
constexpr double kToleranceSigmas = 1.5;
constexpr long kCliqueSteps = 3000;

/// What stands around an object: counts by class and distance, each spread over the two nearest bins, unit length.
Eigen::VectorXd signature(const PlanarScene& scene, const PlanarObject& object) {
  const int classes = static_cast<int>(scene.class_begin.size()) - 1;
  Eigen::VectorXd bins = Eigen::VectorXd::Zero(classes * kSignatureBins);
  for (const PlanarObject& other : scene.objects) {
    const double distance_m = (other.position_m - object.position_m).norm();
    if (&other == &object || distance_m >= kSignatureRadius_m) continue;
    const double place = std::max(0.0, distance_m / kSignatureBin_m - 0.5);
    const int bin = static_cast<int>(place);
    const double next = place - bin;
    bins(other.class_index * kSignatureBins + bin) += 1.0 - next;
    if (bin + 1 < kSignatureBins) bins(other.class_index * kSignatureBins + bin + 1) += next;
  }
  const double norm = bins.norm();
  return norm > 0.0 ? Eigen::VectorXd(bins / norm) : bins;
}

std::vector<Eigen::VectorXd> signatures(const PlanarScene& scene) {
  std::vector<Eigen::VectorXd> result;
  for (const PlanarObject& object : scene.objects) result.push_back(signature(scene, object));
  return result;
}

bool keepsDistance(const PlanarScene& query, const PlanarScene& match, const Correspondence& a,
                   const Correspondence& b) {
  if (a.query == b.query || a.match == b.match) return false;
  const PlanarObject& qa = query.objects[a.query];
  const PlanarObject& qb = query.objects[b.query];
  const PlanarObject& ma = match.objects[a.match];
  const PlanarObject& mb = match.objects[b.match];
  const double in_query_m = (qa.position_m - qb.position_m).norm();
  const double in_match_m = (ma.position_m - mb.position_m).norm();
  if (in_query_m < kMinDistance_m || in_match_m < kMinDistance_m) return false;
  const double stddev_m = std::sqrt(qa.variance_m2 + qb.variance_m2 + ma.variance_m2 + mb.variance_m2);
  return std::abs(in_query_m - in_match_m) < kToleranceSigmas * stddev_m;
}

}  // namespace

std::vector<Correspondence> findCorrespondences(const PlanarScene& query, const PlanarScene& match, int per_object) {
  const std::vector<Eigen::VectorXd> of_query = signatures(query);
  const std::vector<Eigen::VectorXd> of_match = signatures(match);
  std::vector<Correspondence> result;
  for (int i = 0; i < query.size(); ++i) {
    const ClassIndex c = query.objects[i].class_index;
    std::vector<std::pair<double, int>> ranked;  // the most alike first
    for (int j = match.class_begin[c]; j < match.class_begin[c + 1]; ++j) {
      ranked.emplace_back(-of_query[i].dot(of_match[j]), j);
    }
    std::sort(ranked.begin(), ranked.end());
    if (static_cast<int>(ranked.size()) > per_object) ranked.resize(per_object);
    for (const auto& candidate : ranked) result.push_back({i, candidate.second});
  }
  return result;
}

PlanarGuess motionOf(const PlanarScene& query, const PlanarScene& match,
                     const std::vector<Correspondence>& correspondences) {
  PlanarGuess motion;
  if (correspondences.empty()) return motion;
  Eigen::Vector2d source_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d target_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d product_m2 = Eigen::Matrix2d::Zero();
  const double count = static_cast<double>(correspondences.size());
  for (const Correspondence& pair : correspondences) {
    source_m += (query.objects[pair.query].position_m - query.centre_m) / count;
    target_m += (match.objects[pair.match].position_m - match.centre_m) / count;
  }
  for (const Correspondence& pair : correspondences) {
    product_m2 += (match.objects[pair.match].position_m - match.centre_m - target_m) *
                  (query.objects[pair.query].position_m - query.centre_m - source_m).transpose();
  }
  motion.yaw_rad = std::atan2(product_m2(1, 0) - product_m2(0, 1), product_m2(0, 0) + product_m2(1, 1));
  motion.shift_m = target_m - Eigen::Rotation2Dd(motion.yaw_rad) * source_m;
  motion.votes = count;
  return motion;
}

double residual(const PlanarScene& query, const PlanarScene& match, const PlanarGuess& motion,
                const Correspondence& correspondence) {
  return (moved(motion, query, match, query.objects[correspondence.query].position_m) -
          match.objects[correspondence.match].position_m)
      .norm();
}

std::vector<PlanarGuess> guessByCliques(const PlanarScene& query, const PlanarScene& match) {
  std::vector<Correspondence> left = findCorrespondences(query, match, kCandidatesPerObject);
  std::vector<PlanarGuess> guesses;
  for (int round = 0; round < kMaxCliques && left.size() > 2; ++round) {
    BitGraph graph(static_cast<int>(left.size()));
    for (int a = 0; a < graph.size(); ++a) {
      for (int b = a + 1; b < graph.size(); ++b) {
        if (keepsDistance(query, match, left[a], left[b])) graph.join(a, b);
      }
    }
    const std::vector<int> clique = maximumClique(graph, kCliqueSteps);
    if (clique.size() < 3) break;
    std::vector<Correspondence> chosen;
    for (const int node : clique) chosen.push_back(left[node]);
    guesses.push_back(motionOf(query, match, chosen));
    for (auto node = clique.rbegin(); node != clique.rend(); ++node) left.erase(left.begin() + *node);
  }
  return guesses;
}

}  // namespace semantic_mht_slam
