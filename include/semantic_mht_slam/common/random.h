#pragma once

#include <cstdint>
#include <string_view>

namespace semantic_mht_slam {

class StateArchive;

/// Seeded random source with the same sequence on every platform and standard library
/// (xoshiro256** by Blackman and Vigna, seeded through SplitMix64).
///
/// The distributions of <random> are not used because their algorithms are left to the implementation.
class Rng {
 public:
  explicit Rng(std::uint64_t seed);

  /// An independent source named by `label` and, for repeated forks, `index`. Depends on the seed of this source only,
  /// never on how many numbers were drawn from it, so that adding a consumer does not shift the others.
  Rng fork(std::string_view label, std::uint64_t index = 0) const;

  /// 64 uniform bits.
  std::uint64_t bits();

  /// Uniform in [0, 1).
  double uniform();

  /// Uniform in [low, high). Throws std::invalid_argument unless low <= high.
  double uniform(double low, double high);

  /// Uniform integer in [0, count). Throws std::invalid_argument for count 0.
  std::uint64_t index(std::uint64_t count);

  /// Normal with mean 0 and standard deviation 1 (Marsaglia's polar method).
  double normal();
  double normal(double mean, double stddev) { return mean + stddev * normal(); }

  /// True with probability `prob`.
  bool bernoulli(double prob) { return uniform() < prob; }

  /// Poisson distributed count; `mean` in [0, 700], else std::invalid_argument.
  std::uint64_t poisson(double mean);

  /// Where in its sequence the source is (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  std::uint64_t seed_;
  std::uint64_t state_[4];
  double spare_normal_ = 0.0;
  bool has_spare_normal_ = false;
};

}  // namespace semantic_mht_slam
