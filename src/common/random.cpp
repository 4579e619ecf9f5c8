#include "semantic_mht_slam/common/random.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "semantic_mht_slam/common/digest.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

std::uint64_t splitMix64(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15ULL);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

std::uint64_t rotateLeft(std::uint64_t x, int k) {
  return (x << k) | (x >> (64 - k));
}

}  // namespace

Rng::Rng(std::uint64_t seed) : seed_(seed) {
  for (std::uint64_t& word : state_) word = splitMix64(seed);
}

Rng Rng::fork(std::string_view label, std::uint64_t index) const {
  std::uint64_t mixed = seed_;
  mixed = splitMix64(mixed) ^ digestOf(label);
  mixed = splitMix64(mixed) ^ index;
  return Rng(splitMix64(mixed));
}

std::uint64_t Rng::bits() {
  const std::uint64_t result = rotateLeft(state_[1] * 5, 7) * 9;
  const std::uint64_t shifted = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = rotateLeft(state_[3], 45);
  return result;
}

double Rng::uniform() {
  return static_cast<double>(bits() >> 11) * 0x1.0p-53;
}

double Rng::uniform(double low, double high) {
  if (!(low <= high)) throw std::invalid_argument("Rng::uniform: low above high");
  return low + (high - low) * uniform();
}

std::uint64_t Rng::index(std::uint64_t count) {
  if (count == 0) throw std::invalid_argument("Rng::index: count 0");
  const std::uint64_t limit = UINT64_MAX - UINT64_MAX % count;  // rejection keeps it unbiased
  std::uint64_t value = bits();
  while (value >= limit) value = bits();
  return value % count;
}

double Rng::normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  double u = 0.0;
  double v = 0.0;
  double s = 0.0;
  do {
    u = uniform(-1.0, 1.0);
    v = uniform(-1.0, 1.0);
    s = u * u + v * v;
  } while (s >= 1.0 || s == 0.0);
  const double factor = std::sqrt(-2.0 * std::log(s) / s);
  spare_normal_ = v * factor;
  has_spare_normal_ = true;
  return u * factor;
}

std::uint64_t Rng::poisson(double mean) {
  if (!(mean >= 0.0 && mean <= 700.0)) throw std::invalid_argument("Rng::poisson: mean outside [0, 700]");
  const double limit = std::exp(-mean);
  std::uint64_t count = 0;
  for (double product = uniform(); product > limit; product *= uniform()) ++count;
  return count;
}

void Rng::transfer(StateArchive& archive) {
  archive(seed_);
  for (std::uint64_t& word : state_) archive(word);
  archive(spare_normal_, has_spare_normal_);
  const bool gives_numbers =
      std::any_of(std::begin(state_), std::end(state_), [](std::uint64_t word) { return word != 0; });
  archive.require(gives_numbers, "random numbers that are all zero");
}

}  // namespace semantic_mht_slam
