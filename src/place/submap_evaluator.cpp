#include "semantic_mht_slam/place/submap_evaluator.h"

namespace semantic_mht_slam {

void describe(SubmapEvaluatorConfig& config, Fields& fields) {
  fields.add("check_all", config.check_all,
             "Searches every submap that has landmarks for loop closures; the tree is not read.");
  fields.add("tree", config.tree,
             "Decision tree that picks the submaps worth a search, made by train_submap_evaluator; relative to this "
             "file or to "
             "the package's config.");
}

SubmapEvaluation SubmapEvaluator::add(const Submap& submap) {
  SubmapEvaluation evaluation;
  evaluation.features = extractor_.add(submap);
  if (!evaluation.features) return evaluation;
  evaluation.good_prob = classifier_ ? classifier_->goodProb(*evaluation.features) : 1.0;
  evaluation.worth_checking = !classifier_ || classifier_->isWorthChecking(*evaluation.features);
  return evaluation;
}

SubmapEvaluator makeSubmapEvaluator(const SubmapEvaluatorConfig& config, const std::string& tree_path, int classes) {
  const bool says_nothing = classes == 1;  // tf-idf is the same of all submaps
  if (config.check_all || says_nothing) return SubmapEvaluator(classes);
  return SubmapEvaluator(classes, SubmapClassifier::load(tree_path));
}

}  // namespace semantic_mht_slam
