#pragma once

#include <chrono>

namespace semantic_mht_slam {

/// Wall clock time since it was made.
class Stopwatch {
 public:
  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  double elapsed_ms() const { return 1e3 * elapsed_s(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace semantic_mht_slam
