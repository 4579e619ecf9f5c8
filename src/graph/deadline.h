#pragma once

#include <algorithm>

#include "semantic_mht_slam/common/stopwatch.h"

namespace semantic_mht_slam {

/// The end of a span of wall clock time that begins now; a budget of 0 never ends.
class Deadline {
 public:
  explicit Deadline(double budget_s) : budget_s_(budget_s) {}

  bool hasPassed() const { return budget_s_ > 0.0 && watch_.elapsed_s() >= budget_s_; }

  /// What a solver may take of the time that is left, for which 0 means no limit.
  double left_s(double share = 1.0) const {
    constexpr double kLeast_s = 1e-6;
    return budget_s_ > 0.0 ? std::max(kLeast_s, share * (budget_s_ - watch_.elapsed_s())) : 0.0;
  }

 private:
  Stopwatch watch_;
  double budget_s_;
};

}  // namespace semantic_mht_slam
