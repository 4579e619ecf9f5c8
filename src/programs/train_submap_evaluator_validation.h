#pragma once

#include <functional>
#include <vector>

#include "semantic_mht_slam/place/submap_classifier.h"

#include "train_submap_evaluator_drives.h"

namespace semantic_mht_slam {

/// How well a choice of submaps does. Shares of nothing are 0.
struct ChoiceScore {
  int submaps = 0;
  int revisits = 0;  ///< submaps with a place that had been driven through before
  int good = 0;      ///< those of them that can be recognised
  int chosen = 0;
  int chosen_revisits = 0;
  int chosen_good = 0;

  double precision() const { return share(chosen_good, chosen); }
  double recall() const { return share(chosen_good, good); }
  double revisitRecall() const { return share(chosen_revisits, revisits); }
  double skipped() const { return share(submaps - chosen, submaps); }

 private:
  static double share(int part, int whole) { return whole == 0 ? 0.0 : static_cast<double>(part) / whole; }
};

/// Scores the submaps of drives that a tree would search.
ChoiceScore scoreChoice(const std::vector<LabelledDrive>& drives, const SubmapClassifier& classifier);

/// A tree grown on all submaps with landmarks. Throws InputError if there is nothing to learn.
SubmapClassifier trainOn(const std::vector<LabelledDrive>& drives, const TreeTraining& training);

/// Outcome of a cross-validation.
struct CrossValidation {
  double min_prob = 0.0;  ///< the largest at which the recall is as wanted
  ChoiceScore score;      ///< at that threshold
};

/// Predicts the submaps of every drive by a tree that was grown on drives of other folds (the submaps of one drive see
/// the same streets, so a drive is never split), and finds the threshold that keeps `recall` of the good ones.
/// Throws InputError with fewer than two drives or if there is nothing to learn.
CrossValidation crossValidate(const std::vector<LabelledDrive>& drives, const TreeTraining& training, double recall);

}  // namespace semantic_mht_slam
