#include "train_submap_evaluator_validation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kFolds = 10;

struct Prediction {
  double good_prob = 0.0;  // -1 without landmarks: never searched
  bool is_revisit = false;
  bool is_good = false;
};

std::vector<Prediction> predict(const LabelledDrive& drive, const SubmapClassifier& classifier) {
  std::vector<Prediction> predictions;
  for (const DrivenSubmap& submap : drive.submaps) {
    const double good_prob = submap.features ? classifier.goodProb(*submap.features) : -1.0;
    predictions.push_back({good_prob, submap.is_revisit, submap.is_good});
  }
  return predictions;
}

ChoiceScore scoreOf(const std::vector<Prediction>& predictions, double min_prob) {
  ChoiceScore score;
  for (const Prediction& prediction : predictions) {
    const bool is_chosen = prediction.good_prob >= min_prob;
    ++score.submaps;
    score.revisits += prediction.is_revisit;
    score.good += prediction.is_good;
    score.chosen += is_chosen;
    score.chosen_revisits += is_chosen && prediction.is_revisit;
    score.chosen_good += is_chosen && prediction.is_good;
  }
  return score;
}

double thresholdFor(const std::vector<Prediction>& predictions, double recall) {
  std::vector<double> good_probs;
  for (const Prediction& prediction : predictions) {
    if (prediction.is_good) good_probs.push_back(std::max(prediction.good_prob, 0.0));
  }
  if (good_probs.empty()) return 0.0;
  std::sort(good_probs.begin(), good_probs.end());
  const double may_be_lost = std::floor((1.0 - recall) * static_cast<double>(good_probs.size()) + 1e-9);
  return good_probs[std::min(static_cast<std::size_t>(may_be_lost), good_probs.size() - 1)];
}

}  // namespace

ChoiceScore scoreChoice(const std::vector<LabelledDrive>& drives, const SubmapClassifier& classifier) {
  std::vector<Prediction> all;
  for (const LabelledDrive& drive : drives) {
    const auto predictions = predict(drive, classifier);
    all.insert(all.end(), predictions.begin(), predictions.end());
  }
  return scoreOf(all, classifier.minProb());
}

SubmapClassifier trainOn(const std::vector<LabelledDrive>& drives, const TreeTraining& training) {
  std::vector<LabelledSubmap> samples;
  for (const LabelledDrive& drive : drives) {
    for (const DrivenSubmap& submap : drive.submaps) {
      if (submap.features) samples.push_back({*submap.features, submap.is_good});
    }
  }
  try {
    return SubmapClassifier::train(samples, training);
  } catch (const std::invalid_argument&) {
    throw InputError("the drives hold no revisited submaps, or nothing else: there is nothing to learn");
  }
}

CrossValidation crossValidate(const std::vector<LabelledDrive>& drives, const TreeTraining& training, double recall) {
  if (drives.size() < 2) throw InputError("at least two drives are needed, one to test what the others taught");
  const std::size_t folds = std::min(kFolds, drives.size());
  std::vector<Prediction> all;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<LabelledDrive> others;
    for (std::size_t i = 0; i < drives.size(); ++i) {
      if (i % folds != fold) others.push_back(drives[i]);
    }
    const SubmapClassifier classifier = trainOn(others, training);
    for (std::size_t i = fold; i < drives.size(); i += folds) {
      const auto predictions = predict(drives[i], classifier);
      all.insert(all.end(), predictions.begin(), predictions.end());
    }
  }
  const double min_prob = thresholdFor(all, recall);
  return {min_prob, scoreOf(all, min_prob)};
}

}  // namespace semantic_mht_slam
