#include "semantic_mht_slam/mapping/class_confusion.h"

#include <stdexcept>

namespace semantic_mht_slam {

ClassConfusion::ClassConfusion(int class_count, double wrong_prob, double prior_samples)
    : class_count_(class_count),
      wrong_prob_(class_count > 1 ? wrong_prob : 0.0),
      prior_samples_(prior_samples),
      counts_(static_cast<std::size_t>(class_count * class_count), 0.0),
      likelihood_(class_count, class_count) {
  for (ClassIndex object = 0; object < class_count_; ++object) evaluate(object);
}

double& ClassConfusion::count(ClassIndex object, ClassIndex detected) {
  if (object < 0 || object >= class_count_ || detected < 0 || detected >= class_count_) {
    throw std::invalid_argument("ClassConfusion: no such class");
  }
  return counts_[static_cast<std::size_t>(object * class_count_ + detected)];
}

void ClassConfusion::add(ClassIndex object, ClassIndex detected) {
  count(object, detected) += 1.0;
  evaluate(object);
}

void ClassConfusion::evaluate(ClassIndex object) {
  double total = prior_samples_;
  for (ClassIndex detected = 0; detected < class_count_; ++detected) total += count(object, detected);
  for (ClassIndex detected = 0; detected < class_count_; ++detected) {
    const double prior = detected == object ? 1.0 - wrong_prob_ : wrong_prob_ / (class_count_ - 1);
    likelihood_(detected, object) = (count(object, detected) + prior_samples_ * prior) / total;
  }
}

}  // namespace semantic_mht_slam
