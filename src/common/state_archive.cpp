#include "semantic_mht_slam/common/state_archive.h"

#include <cmath>
#include <cstring>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/ros_time.h"
#include "semantic_mht_slam/common/state_checks.h"

namespace semantic_mht_slam {
namespace {

constexpr int kMaxVarintBytes = 10;
constexpr double kLargest = 1e100;    // its square is a number, too
constexpr double kFurthest_m = 1e11;  // poses; odometry is used up to 1e10 m
constexpr std::uint64_t kLastName = std::uint64_t{1} << 62U;

}  // namespace

void StateArchive::fail(const std::string& what) {
  throw InputError("broken state: " + what);
}

StateArchive::StateArchive(std::string_view bytes, KeepReading keep_reading, int classes, std::size_t memory)
    : is_reading_(true), input_(bytes), keep_reading_(std::move(keep_reading)), classes_(classes), memory_(memory) {
  const std::uint64_t numbers = varint(0);
  if (numbers > input_.size() / sizeof(double)) fail("more numbers than bytes");
  new_numbers_ = input_.substr(0, numbers * sizeof(double));
  input_.remove_prefix(new_numbers_.size());
}

std::string StateArchive::written() const {
  StateArchive head;
  head.varint(written_new_.size());
  std::string result = std::move(head.output_);
  result.reserve(result.size() + sizeof(double) * written_new_.size() + output_.size());
  for (unsigned shift = 0; shift < 64; shift += 8) {
    for (const std::uint64_t bits : written_new_) result.push_back(static_cast<char>(bits >> shift));
  }
  return result + output_;
}

void StateArchive::requireEnd() const {
  const std::size_t unread = new_numbers_.size() / sizeof(double) - next_new_;
  if (!input_.empty()) fail(std::to_string(input_.size()) + " bytes too many");
  if (unread > 0) fail(std::to_string(unread) + " numbers too many");
}

std::uint8_t StateArchive::byte(std::uint8_t value) {
  if (!is_reading_) {
    output_.push_back(static_cast<char>(value));
    return value;
  }
  if (input_.empty()) fail("it ends too early");
  const auto result = static_cast<std::uint8_t>(input_.front());
  input_.remove_prefix(1);
  return result;
}

/// What could not be read again is not written either.
void StateArchive::number(double& value) {
  if (is_reading_) {
    const std::uint64_t bits = nextNumber();
    std::memcpy(&value, &bits, sizeof value);
    if (!(std::abs(value) <= kLargest)) fail("a number is not finite, or too large");
    return;
  }
  if (!(std::abs(value) <= kLargest)) throw InputError("a number of the map is not finite, or too large");
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  const auto [last, is_new] = last_at_.try_emplace(bits, written_numbers_);
  varint(written_numbers_ - last->second);  // 0: not written before
  if (is_new) written_new_.push_back(bits);
  last->second = written_numbers_++;
}

/// The bits of the next double.
std::uint64_t StateArchive::nextNumber() {
  const std::uint64_t back = varint(0);
  if (back > numbers_.size()) fail("it repeats a number that there is not");
  std::uint64_t bits = 0;
  if (back > 0) {
    bits = numbers_[numbers_.size() - back];
  } else {
    const std::size_t count = new_numbers_.size() / sizeof(double);
    if (next_new_ == count) fail("it ends too early");
    for (std::size_t i = 0; i < sizeof(double); ++i) {
      const auto part = static_cast<std::uint8_t>(new_numbers_[i * count + next_new_]);
      bits |= static_cast<std::uint64_t>(part) << (8 * i);
    }
    ++next_new_;
  }
  takeMemory(1, sizeof bits);
  numbers_.push_back(bits);
  return bits;
}

void StateArchive::requireClass(int class_index) const {
  require(class_index >= 0 && (classes_ == kAnyClasses || class_index < classes_), "a class that the table lacks");
}

void StateArchive::requireClassCount(std::ptrdiff_t count) const {
  require(classes_ == kAnyClasses || count == classes_, "probabilities of other classes than the table has");
}

void StateArchive::requireName(std::uint64_t landmark) const {
  require(landmark > 0 && landmark < kLastName, "a name of a landmark that cannot be given");
}

void StateArchive::requireStamp(std::int64_t stamp) const {
  require(isRosTime(stamp), "a stamp before or after the time of ROS");
}

std::uint64_t StateArchive::varint(std::uint64_t value) {
  std::uint64_t result = 0;
  for (int i = 0; i < kMaxVarintBytes; ++i) {
    const bool is_last = value < 128;
    const std::uint8_t part = byte(static_cast<std::uint8_t>((value & 127) | (is_last ? 0 : 128)));
    result |= static_cast<std::uint64_t>(part & 127) << (7 * i);
    if ((part & 128) == 0) return result;
    value >>= 7;
  }
  fail("a number has too many bytes");
}

void StateArchive::requireGoingOn() const {
  if (keep_reading_ && !keep_reading_()) throw InputError("reading was given up");
}

std::size_t StateArchive::count(std::size_t elements, std::size_t element_size) {
  requireGoingOn();
  const std::uint64_t result = varint(elements);
  if (!is_reading_) return elements;
  if (result > input_.size()) fail("a list is longer than its state");
  takeMemory(result, element_size);
  return static_cast<std::size_t>(result);
}

void StateArchive::takeMemory(std::size_t elements, std::size_t element_size) {
  if (elements > memory_ / element_size) fail("it takes more memory than a file of its size may");
  memory_ -= elements * element_size;
}

void StateArchive::transferText(std::string& text) {
  const std::size_t length = count<char>(text.size());
  if (!is_reading_) {
    output_ += text;
    return;
  }
  text = std::string(input_.substr(0, length));
  input_.remove_prefix(length);
}

void transfer(StateArchive& archive, std::string& text) {
  archive.transferText(text);
}

void transfer(StateArchive& archive, Pose& pose) {
  archive(pose.rotation.coeffs(), pose.translation_m);
  const bool is_near = pose.translation_m.cwiseAbs().maxCoeff() <= kFurthest_m;
  archive.require(pose.isValid() && is_near, "a pose that is none, or beyond any place");
}

void transfer(StateArchive& archive, StampedPose& pose) {
  auto& [stamp, T_world_base] = pose;
  archive(stamp, T_world_base);
  archive.requireStamp(stamp);
}

void transfer(StateArchive& archive, Gaussian3& gaussian) {
  auto& [mean_m, cov_m2] = gaussian;
  archive(mean_m, cov_m2);
  archive.require(mean_m.cwiseAbs().maxCoeff() <= kFurthest_m, "a place beyond any");
  archive.require(isPositive(cov_m2), "a covariance that is not positive");
}

void transfer(StateArchive& archive, std::vector<bool>& list) {
  const std::size_t count = archive.count<char>(list.size());
  if (archive.isReading()) list.assign(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    bool value = list[i];
    archive(value);
    list[i] = value;
  }
}

}  // namespace semantic_mht_slam
