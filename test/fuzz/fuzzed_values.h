#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// Draws values from bytes, many of them such as nobody expects; zeros when they are used up.
class FuzzedValues {
 public:
  explicit FuzzedValues(const std::string& bytes) : bytes_(bytes) {}

  bool isEmpty() const { return place_ >= bytes_.size(); }

  std::uint8_t byte() { return isEmpty() ? 0 : static_cast<std::uint8_t>(bytes_[place_++]); }

  /// Small, hostile, or any bits.
  double number() {
    constexpr double kHostile[] = {std::numeric_limits<double>::quiet_NaN(),
                                   std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity(),
                                   1e308,
                                   -1e308,
                                   1e-308,
                                   1e10,
                                   1e5};
    const std::uint8_t kind = byte();
    if (kind < 200) return 0.25 * (kind - 100);
    return kind < 240 ? kHostile[kind % 8] : bits<double>();
  }

  Eigen::Vector3d vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

  /// With no rotation in half of the cases.
  Pose pose() {
    Pose pose;
    pose.translation_m = vector();
    if (byte() % 2 == 0) return pose;
    const Eigen::Vector3d imaginary = vector();
    pose.rotation = Eigen::Quaterniond(number(), imaginary.x(), imaginary.y(), imaginary.z());
    return pose;
  }

  /// Near `now`, or any that ROS can write.
  Stamp stamp(Stamp now) {
    const std::uint8_t kind = byte();
    if (kind < 200) return now + (kind - 100) * 10000000LL;
    if (kind < 230) return now + (kind - 215) * 10000000000LL;
    constexpr Stamp kLast = 4294967295LL * 1000000000LL;
    return static_cast<Stamp>(bits<std::uint64_t>() % static_cast<std::uint64_t>(kLast));
  }

 private:
  template <class Value>
  Value bits() {
    Value value{};
    if (place_ + sizeof value <= bytes_.size()) std::memcpy(&value, &bytes_[place_], sizeof value);
    place_ += sizeof value;
    return value;
  }

  const std::string& bytes_;
  std::size_t place_ = 0;
};

}  // namespace semantic_mht_slam
