#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/common/matrix_form.h"
#include "semantic_mht_slam/common/stamped_pose.h"

namespace semantic_mht_slam {

/// Asked now and then while something long is read; false: give up.
using KeepReading = std::function<bool()>;

/// Values to bytes and back, without loss. One function a type, `transfer(archive, value)` or a member
/// `transfer(archive)`, serves both directions, so that what is written and what is read cannot differ; a writing
/// archive changes no value. Integers take as many bytes as they need, a square matrix only what its form (zero,
/// diagonal, symmetric, upper triangular) leaves open. A double takes eight bytes and one; one that was written before
/// only says how long ago. All doubles stand before everything else, their first bytes first: what is alike is side by
/// side, which is what a compressor needs.
///
/// Reading bytes that are no such state throws InputError; whoever reads gives what has been read so far up. Bytes may
/// come from anybody: numbers are finite, each `transfer` requires of what it has read whatever the program relies on,
/// and nothing makes a value that takes much more memory than the bytes it stands in.
class StateArchive {
 public:
  /// Writes.
  StateArchive() = default;

  /// Reads; `bytes` must live as long as the archive. What is read takes no more than `memory` bytes.
  explicit StateArchive(std::string_view bytes, KeepReading keep_reading = {}, int classes = kAnyClasses,
                        std::size_t memory = kMostMemory);

  bool isReading() const { return is_reading_; }

  /// What was written.
  std::string written() const;

  /// Throws InputError if reading is to be given up. Called for every list that is read; whoever does something long
  /// with what was read calls it meanwhile.
  void requireGoingOn() const;

  /// Throws InputError if what was read breaks a rule; what is written is taken as it is.
  void require(bool holds, const char* problem) const {
    if (is_reading_ && !holds) fail(problem);
  }

  /// Throws InputError if a class that was read is not in the table.
  void requireClass(int class_index) const;

  /// Throws InputError if there are other numbers of classes than the table has.
  void requireClassCount(std::ptrdiff_t count) const;

  /// Throws InputError for what is no name of a landmark.
  void requireName(std::uint64_t landmark) const;

  /// Throws InputError for a stamp that ROS cannot write.
  void requireStamp(std::int64_t stamp) const;

  /// Throws InputError unless everything was read.
  void requireEnd() const;

  /// Bytes that what is read may still take.
  std::size_t memoryLeft() const { return memory_; }

  /// Throws InputError: the bytes are no state of what is being read.
  [[noreturn]] static void fail(const std::string& what);

  /// Transfers several values in their order.
  template <class First, class Second, class... Others>
  void operator()(First& first, Second& second, Others&... others) {
    (*this)(first);
    (*this)(second, others...);
  }

  template <class Value>
  void operator()(Value& value) {
    if constexpr (std::is_same_v<Value, double>) {
      number(value);
    } else if constexpr (std::is_enum_v<Value>) {
      auto code = static_cast<std::underlying_type_t<Value>>(value);
      (*this)(code);
      value = static_cast<Value>(code);
    } else if constexpr (std::is_integral_v<Value>) {
      integer(value);
    } else if constexpr (std::is_base_of_v<Eigen::EigenBase<Value>, Value>) {
      matrix(value);
    } else if constexpr (HasTransfer<Value>::value) {
      value.transfer(*this);
    } else {
      transfer(*this, value);
    }
  }

  /// The number of elements that follow, each of at least one byte, which take so much memory.
  std::size_t count(std::size_t elements, std::size_t element_size);

  template <class Element>
  std::size_t count(std::size_t elements) {
    return count(elements, sizeof(Element));
  }

  static constexpr std::size_t kNode = 40;  ///< that a set or a map takes beside each element

  void transferText(std::string& text);

 private:
  template <class Value, class = void>
  struct HasTransfer : std::false_type {};
  template <class Value>
  struct HasTransfer<Value, std::void_t<decltype(std::declval<Value&>().transfer(std::declval<StateArchive&>()))>>
      : std::true_type {};

  void takeMemory(std::size_t elements, std::size_t element_size);
  void number(double& value);
  std::uint64_t nextNumber();
  std::uint64_t varint(std::uint64_t value);
  std::uint8_t byte(std::uint8_t value);

  template <class Integer>
  void integer(Integer& value) {
    // Zigzag: small numbers of either sign become small codes.
    const auto wide = static_cast<std::int64_t>(value);
    const std::uint64_t code = varint((static_cast<std::uint64_t>(wide) << 1) ^ static_cast<std::uint64_t>(wide >> 63));
    if (!is_reading_) return;
    const auto decoded = static_cast<std::int64_t>((code >> 1) ^ (~(code & 1) + 1));
    value = static_cast<Integer>(decoded);
    if (static_cast<std::int64_t>(value) != decoded) fail("a number is out of range");
  }

  template <class Matrix>
  void resize(Matrix& values);
  template <class Matrix>
  void matrix(Matrix& values);

  static constexpr Eigen::Index kMaxSide = 4096;
  static constexpr int kAnyClasses = -1;
  static constexpr std::size_t kMostMemory = std::size_t{1} << 30U;  // where nobody says less

  bool is_reading_ = false;
  std::string_view input_;
  KeepReading keep_reading_;
  std::string output_;
  std::vector<std::uint64_t> numbers_;                      ///< all doubles that were read, as bits
  std::string_view new_numbers_;                            ///< those that nothing repeats: planes of bytes
  std::size_t next_new_ = 0;                                ///< that is still to be read
  std::vector<std::uint64_t> written_new_;                  ///< as `new_numbers_`
  std::unordered_map<std::uint64_t, std::size_t> last_at_;  ///< where a double was written last
  std::size_t written_numbers_ = 0;
  int classes_ = kAnyClasses;
  std::size_t memory_ = kMostMemory;  ///< that is left: bytes may be much shorter than the values they stand for
};

void transfer(StateArchive& archive, std::string& text);
void transfer(StateArchive& archive, Pose& pose);
void transfer(StateArchive& archive, StampedPose& pose);
void transfer(StateArchive& archive, Gaussian3& gaussian);

template <class A, class B>
void transfer(StateArchive& archive, std::pair<A, B>& pair) {
  archive(pair.first, pair.second);
}

template <class Value, std::size_t kSize>
void transfer(StateArchive& archive, std::array<Value, kSize>& values) {
  for (Value& value : values) archive(value);
}

template <class Value>
void transfer(StateArchive& archive, std::optional<Value>& value) {
  bool has_value = value.has_value();
  archive(has_value);
  if (archive.isReading()) value = has_value ? std::optional<Value>(std::in_place) : std::nullopt;
  if (has_value) archive(*value);
}

/// `count` has looked whether there is the memory for that many.
template <class Value>
void makeRoom(std::vector<Value>& list, std::size_t count) {
  list.reserve(count);
}

template <class Value>
void makeRoom(std::deque<Value>& /*list*/, std::size_t /*count*/) {}

/// Elements one by one, so that bytes that end too early are found at once.
template <class List>
void transferList(StateArchive& archive, List& list) {
  const std::size_t count = archive.count<typename List::value_type>(list.size());
  if (!archive.isReading()) {
    for (auto& value : list) archive(value);
    return;
  }
  list.clear();
  makeRoom(list, count);
  for (std::size_t i = 0; i < count; ++i) archive(list.emplace_back());
}

template <class Value>
void transfer(StateArchive& archive, std::vector<Value>& list) {
  transferList(archive, list);
}

template <class Value>
void transfer(StateArchive& archive, std::deque<Value>& list) {
  transferList(archive, list);
}

void transfer(StateArchive& archive, std::vector<bool>& list);

template <class Key>
void transfer(StateArchive& archive, std::set<Key>& set) {
  const std::size_t count = archive.count(set.size(), sizeof(Key) + StateArchive::kNode);
  if (!archive.isReading()) {
    for (Key key : set) archive(key);
    return;
  }
  set.clear();
  for (std::size_t i = 0; i < count; ++i) {
    Key key{};
    archive(key);
    set.insert(key);
  }
}

template <class Key, class Value>
void transfer(StateArchive& archive, std::map<Key, Value>& map) {
  const std::size_t count = archive.count(map.size(), sizeof(std::pair<const Key, Value>) + StateArchive::kNode);
  if (!archive.isReading()) {
    for (auto& [key, value] : map) {
      Key copy = key;
      archive(copy, value);
    }
    return;
  }
  map.clear();
  for (std::size_t i = 0; i < count; ++i) {
    Key key{};
    archive(key);
    if (!map.empty() && !(map.rbegin()->first < key)) StateArchive::fail("numbers do not rise");
    archive(map.emplace_hint(map.end(), std::piecewise_construct, std::forward_as_tuple(key), std::tuple<>())->second);
  }
}

template <class Matrix>
void StateArchive::resize(Matrix& values) {
  Eigen::Index rows = values.rows();
  Eigen::Index cols = values.cols();
  (*this)(rows, cols);
  if (!is_reading_) return;
  const auto fits = [](Eigen::Index size, Eigen::Index fixed, Eigen::Index most) {
    if (fixed != Eigen::Dynamic) return size == fixed;
    return size >= 0 && size <= (most == Eigen::Dynamic ? kMaxSide : most);
  };
  const bool is_possible = fits(rows, Matrix::RowsAtCompileTime, Matrix::MaxRowsAtCompileTime) &&
                           fits(cols, Matrix::ColsAtCompileTime, Matrix::MaxColsAtCompileTime);
  if (!is_possible) fail("a matrix has an impossible size");
  takeMemory(static_cast<std::size_t>(rows * cols), sizeof(typename Matrix::Scalar));
  values.setZero(rows, cols);
}

template <class Matrix>
void StateArchive::matrix(Matrix& values) {
  if (Matrix::RowsAtCompileTime == Eigen::Dynamic || Matrix::ColsAtCompileTime == Eigen::Dynamic) resize(values);
  MatrixForm form = MatrixForm::kFull;
  if (values.rows() == values.cols() && values.rows() > 1) {
    if (!is_reading_) form = formOf(values);
    (*this)(form);
    if (form > MatrixForm::kUpper) fail("a matrix has no known form");
    if (is_reading_) values.setZero();
  }
  for (Eigen::Index col = 0; col < values.cols(); ++col) {
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      const bool is_below = row > col;
      if (form == MatrixForm::kZero || (form == MatrixForm::kDiagonal && row != col)) continue;
      if (is_below && (form == MatrixForm::kUpper || form == MatrixForm::kSymmetric)) continue;
      (*this)(values(row, col));
      if (form == MatrixForm::kSymmetric && is_reading_) values(col, row) = values(row, col);
    }
  }
}

}  // namespace semantic_mht_slam
