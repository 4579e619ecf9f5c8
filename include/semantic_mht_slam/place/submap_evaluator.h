#pragma once

#include <optional>
#include <string>
#include <utility>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/place/submap_classifier.h"

namespace semantic_mht_slam {

/// Which submaps are searched for loop closures.
struct SubmapEvaluatorConfig {
  bool check_all = true;
  std::string tree = "submap_evaluator.yaml";
};

void describe(SubmapEvaluatorConfig& config, Fields& fields);

/// What is known of a submap as a source of loop closures.
struct SubmapEvaluation {
  std::optional<SubmapFeatures> features;  ///< empty without landmarks
  double good_prob = 0.0;                  ///< 1 if every submap is checked
  bool worth_checking = false;             ///< never without landmarks
};

/// Decides for each finished submap of a drive whether to search it for loop closures (paper, section III-A).
class SubmapEvaluator {
 public:
  /// Checks every submap that has landmarks.
  explicit SubmapEvaluator(int classes) : extractor_(classes) {}

  /// Checks the submaps that the tree finds worth it.
  SubmapEvaluator(int classes, SubmapClassifier classifier) : extractor_(classes), classifier_(std::move(classifier)) {}

  /// Evaluates the next submap of the drive; submaps must come in their order, as the rarity of classes is counted.
  SubmapEvaluation add(const Submap& submap);

 private:
  SubmapFeatureExtractor extractor_;
  std::optional<SubmapClassifier> classifier_;
};

/// The evaluator of a configuration; `tree_path` is where `config.tree` was found. Throws InputError if it cannot be
/// used; it is not read if every submap is to be checked.
SubmapEvaluator makeSubmapEvaluator(const SubmapEvaluatorConfig& config, const std::string& tree_path, int classes);

}  // namespace semantic_mht_slam
