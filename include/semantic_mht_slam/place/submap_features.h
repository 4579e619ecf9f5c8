#pragma once

#include <array>
#include <optional>
#include <vector>

#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/place/class_histogram.h"

namespace semantic_mht_slam {

/// What tells whether a submap is worth a search for loop closures (paper, section III-A).
struct SubmapFeatures {
  double entropy = 0.0;  ///< of the landmark mixture's single-Gaussian approximation, nats
  double tf_idf = 0.0;   ///< how rare its classes are among the submaps so far
  int landmarks = 0;
};

constexpr std::array<const char*, 3> kSubmapFeatureNames = {"entropy", "tf_idf", "landmarks"};

/// The features in the order of kSubmapFeatureNames.
std::array<double, 3> toArray(const SubmapFeatures& features);

/// Entropy (1/2) log((2 pi e)^3 det Sigma) in nats (paper, section III-A). Sigma is the covariance of one Gaussian with
/// the moments of the mixture of all landmarks, each weighted by its existence: it measures how far the landmarks
/// spread and, to a lesser part, how uncertain they are. Empty without landmarks.
std::optional<double> mixtureEntropy(const std::vector<MixtureLandmark>& landmarks);

/// Computes the features of one submap after the other. Landmarks that probably do not exist do not count.
class SubmapFeatureExtractor {
 public:
  /// Throws std::invalid_argument unless 1 <= classes <= kMaxClasses.
  explicit SubmapFeatureExtractor(int classes);

  /// Features of the next submap of the drive; empty for one without landmarks. The tf-idf score is
  /// sum_c n_c^i / n^i log(N / n_c): n_c^i landmarks of class c among the n^i of this submap, N submaps so far with
  /// this one, n_c of them with class c. (The paper counts scenes for n_c, of which a submap has many, so that the
  /// score can turn negative.)
  std::optional<SubmapFeatures> add(const Submap& submap);

 private:
  double tfIdf(const ClassHistogram& histogram) const;

  static constexpr double kMinExistenceProb = 0.5;

  int classes_;
  int submaps_ = 0;
  std::vector<int> submaps_with_class_;
};

}  // namespace semantic_mht_slam
