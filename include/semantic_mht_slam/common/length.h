#pragma once

namespace semantic_mht_slam {

/// A length of the configuration that fits the sensor unless it is set: its default is what suits a detector that sees
/// as far as `kReferenceRange_m`; for another one it is scaled.
class Length {
 public:
  /// Range that nine of ten detections of the reference detector do not exceed.
  static constexpr double kReferenceRange_m = 33.0;

  explicit Length(double value, int power = 1) : value_(value), power_(power) {}  ///< power 2: an area

  /// Fixes it.
  Length& operator=(double value) {
    value_ = value;
    is_auto_ = false;
    return *this;
  }

  operator double() const { return value_; }

  bool isAuto() const { return is_auto_; }

  /// What it is for a detector that sees `factor` times as far; unless it was set.
  void scale(double factor) {
    for (int i = 0; i < power_ && is_auto_; ++i) value_ *= factor;
  }

 private:
  double value_;
  int power_;
  bool is_auto_ = true;
};

}  // namespace semantic_mht_slam
