#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

class StateArchive;

/// P(detected class | class of the object). Begins with a share of wrong classes that is spread evenly over all others,
/// as if a number of objects of each class had shown it, and learns from objects whose class is certain: a detector
/// takes poles for trunks, hardly ever for buildings.
class ClassConfusion {
 public:
  /// `prior_samples` is the number of detections that the beginning counts for, in each class.
  ClassConfusion(int class_count, double wrong_prob, double prior_samples);

  /// An object was detected as one of the classes.
  void add(ClassIndex object, ClassIndex detected);

  double prob(ClassIndex detected, ClassIndex object) const { return likelihood_(detected, object); }

  /// The likelihood of each class of the object.
  auto likelihoods(ClassIndex detected) const { return likelihood_.row(detected).transpose(); }

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  void evaluate(ClassIndex object);
  double& count(ClassIndex object, ClassIndex detected);

  int class_count_;
  double wrong_prob_;
  double prior_samples_;
  std::vector<double> counts_;  ///< detections of objects, by object and detected class
  Eigen::ArrayXXd likelihood_;  ///< a row a detected class, a column a class of the object
};

}  // namespace semantic_mht_slam
