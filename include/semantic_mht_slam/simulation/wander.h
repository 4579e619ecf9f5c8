#pragma once

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {

/// Mean-reverting noise of a given standard deviation (a stationary Ornstein-Uhlenbeck process, exact for any step).
class Wander {
 public:
  /// `correlation` > 0 is the distance or time after which 1/e of a value is left; else std::invalid_argument.
  Wander(double stddev, double correlation, Rng& rng);

  double value() const { return value_; }

  /// Advances by `step` >= 0, in the unit of `correlation`; the new value.
  double next(double step, Rng& rng);

 private:
  double stddev_;
  double correlation_;
  double value_;
};

}  // namespace semantic_mht_slam
