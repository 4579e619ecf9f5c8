#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {

/// Place of something in the list of its kind. Ids of different kinds cannot be mixed up, and no id is a number by
/// chance.
template <class Tag>
class Id {
 public:
  /// The id of nothing.
  constexpr Id() = default;
  constexpr explicit Id(std::size_t index) : index_(index) {}

  constexpr std::size_t index() const { return index_; }
  constexpr bool isNone() const { return index_ == kNone; }

  Id& operator++() {
    ++index_;
    return *this;
  }

  friend constexpr bool operator==(Id a, Id b) { return a.index_ == b.index_; }
  friend constexpr bool operator!=(Id a, Id b) { return a.index_ != b.index_; }
  friend constexpr bool operator<(Id a, Id b) { return a.index_ < b.index_; }
  friend constexpr bool operator>(Id a, Id b) { return a.index_ > b.index_; }
  friend constexpr bool operator<=(Id a, Id b) { return a.index_ <= b.index_; }
  friend constexpr bool operator>=(Id a, Id b) { return a.index_ >= b.index_; }

  /// One more than the index, so that nothing is a small number, too.
  void transfer(StateArchive& archive) {
    std::size_t number = isNone() ? 0 : index_ + 1;
    archive(number);
    index_ = number == 0 ? kNone : number - 1;
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::size_t index_ = kNone;
};

using SubmapId = Id<struct SubmapTag>;      ///< of a submap, in the order of the drive
using KeyframeId = Id<struct KeyframeTag>;  ///< of a keyframe, in the order of the drive
using ClosureId = Id<struct ClosureTag>;    ///< of a loop closure that was looked at

/// Successive ids, [begin, end).
template <class IdType>
class IdRange {
 public:
  class Iterator {
   public:
    explicit Iterator(IdType id) : id_(id) {}
    IdType operator*() const { return id_; }
    Iterator& operator++() {
      ++id_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return id_ != other.id_; }

   private:
    IdType id_;
  };

  IdRange(IdType begin, IdType end) : begin_(begin), end_(end) {}

  Iterator begin() const { return Iterator(begin_); }
  Iterator end() const { return Iterator(end_); }
  bool empty() const { return !(begin_ < end_); }
  std::size_t size() const { return empty() ? 0 : end_.index() - begin_.index(); }
  IdType front() const { return begin_; }

 private:
  IdType begin_;
  IdType end_;
};

/// A list whose elements are named by ids of one kind.
template <class IdType, class Value>
class IdVector {
 public:
  IdVector() = default;
  explicit IdVector(std::vector<Value> values) : values_(std::move(values)) {}

  const Value& operator[](IdType id) const { return values_[id.index()]; }
  Value& operator[](IdType id) { return values_[id.index()]; }

  /// Throws std::out_of_range.
  const Value& at(IdType id) const { return values_.at(id.index()); }

  bool has(IdType id) const { return id.index() < values_.size(); }
  bool empty() const { return values_.empty(); }
  std::size_t size() const { return values_.size(); }
  const Value& back() const { return values_.back(); }
  Value& back() { return values_.back(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }

  IdType push_back(Value value) {
    values_.push_back(std::move(value));
    return IdType(values_.size() - 1);
  }
  void clear() { values_.clear(); }
  void resize(std::size_t size) { values_.resize(size); }

  /// The id that the next element gets.
  IdType nextId() const { return IdType(values_.size()); }
  IdRange<IdType> ids() const { return {IdType(0), nextId()}; }
  IdRange<IdType> idsFrom(IdType first) const { return {first, nextId()}; }

  void transfer(StateArchive& archive) { archive(values_); }

 private:
  std::vector<Value> values_;
};

}  // namespace semantic_mht_slam
