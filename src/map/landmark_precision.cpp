#include "semantic_mht_slam/map/landmark_precision.h"

#include <cstdint>
#include <cstring>

#include "semantic_mht_slam/common/state_checks.h"

namespace semantic_mht_slam {
namespace {

constexpr int kDroppedBits = 29;  // of 52; what is left are seven digits

/// Not by way of a float: GCC 12 leaves that out where it vectorizes.
double withSevenDigits(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  constexpr std::uint64_t kHalf = std::uint64_t{1} << (kDroppedBits - 1);
  bits = (bits + kHalf) & ~(2 * kHalf - 1);
  std::memcpy(&value, &bits, sizeof bits);
  return value;
}

template <class Dense>
typename Dense::PlainObject withSevenDigits(const Eigen::DenseBase<Dense>& values) {
  return values.derived().unaryExpr([](double value) { return withSevenDigits(value); });
}

Gaussian3 withSevenDigits(const Gaussian3& gaussian) {
  const Eigen::Matrix3d cov_m2 = withSevenDigits(gaussian.cov_m2);
  return {withSevenDigits(gaussian.mean_m), isCovariance(cov_m2) ? cov_m2 : gaussian.cov_m2};
}

}  // namespace

MixtureLandmark withSevenDigits(MixtureLandmark landmark) {
  for (MixtureComponent& component : landmark.components) {
    component.weight = withSevenDigits(component.weight);
    component.position = withSevenDigits(component.position);
  }
  landmark.position = withSevenDigits(landmark.position);
  landmark.class_probs = withSevenDigits(landmark.class_probs);
  landmark.existence_prob = withSevenDigits(landmark.existence_prob);
  landmark.seen_standing_s = withSevenDigits(landmark.seen_standing_s);
  landmark.size.mean_m = withSevenDigits(landmark.size.mean_m);
  return landmark;
}

}  // namespace semantic_mht_slam
