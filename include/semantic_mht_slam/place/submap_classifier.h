#pragma once

#include <memory>
#include <string>
#include <vector>

#include "semantic_mht_slam/place/submap_features.h"

namespace semantic_mht_slam {

/// A submap to learn from.
struct LabelledSubmap {
  SubmapFeatures features;
  bool is_good = false;  ///< a search for loop closures found a true one, or could have
};

/// How a tree is grown. Few, large leaves: a search that is left out costs a loop closure, one that is in vain
/// milliseconds.
struct TreeTraining {
  int max_depth = 3;
  int min_samples = 100;  ///< a node with less is not split
};

/// Decision tree that predicts from its features whether a submap is worth a search (paper, section III-A).
///
/// It is grown as a regression tree on 0 and 1, which makes the same splits as a classification tree by Gini impurity
/// and keeps the share of good submaps in each leaf; `min_prob` decides from that share.
class SubmapClassifier {
 public:
  /// Grows a tree; the same samples in the same order give the same tree.
  /// Throws std::invalid_argument unless there are good and other submaps among the samples.
  static SubmapClassifier train(const std::vector<LabelledSubmap>& samples, const TreeTraining& training);

  /// Reads a file of `toYaml`. Throws InputError naming the file if it cannot be read or holds anything else.
  static SubmapClassifier load(const std::string& path);

  ~SubmapClassifier();
  SubmapClassifier(SubmapClassifier&&) noexcept;
  SubmapClassifier& operator=(SubmapClassifier&&) noexcept;

  /// Share of good submaps among the training samples in the leaf that the features fall into.
  double goodProb(const SubmapFeatures& features) const;

  /// Least share at which a search is worth it; 0 after training: always.
  double minProb() const { return min_prob_; }
  void setMinProb(double min_prob) { min_prob_ = min_prob; }

  /// True if a search for loop closures is worth it.
  bool isWorthChecking(const SubmapFeatures& features) const { return goodProb(features) >= min_prob_; }

  /// The tree as YAML, with a text that says what it was trained on.
  std::string toYaml(const std::string& trained_on) const;

 private:
  struct Tree;

  explicit SubmapClassifier(std::unique_ptr<Tree> tree);

  std::unique_ptr<Tree> tree_;
  double min_prob_ = 0.0;
};

}  // namespace semantic_mht_slam
