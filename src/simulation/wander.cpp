#include "semantic_mht_slam/simulation/wander.h"

#include <cmath>
#include <stdexcept>

namespace semantic_mht_slam {

Wander::Wander(double stddev, double correlation, Rng& rng)
    : stddev_(stddev), correlation_(correlation), value_(rng.normal(0.0, stddev)) {
  if (!(correlation > 0.0)) throw std::invalid_argument("Wander: correlation not above 0");
}

double Wander::next(double step, Rng& rng) {
  const double keep = std::exp(-step / correlation_);
  value_ = keep * value_ + stddev_ * std::sqrt(1.0 - keep * keep) * rng.normal();
  return value_;
}

}  // namespace semantic_mht_slam
