#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <variant>

#include <nav_msgs/Odometry.h>

#include <semantic_mht_slam/SemanticObjectArray.h>

namespace semantic_mht_slam {

/// A message for the estimator.
using InputMessage = std::variant<nav_msgs::OdometryConstPtr, SemanticObjectArrayConstPtr>;

/// Bounded queue between the subscribers and the worker. When it is full the oldest message is dropped and counted.
class InputQueue {
 public:
  explicit InputQueue(std::size_t capacity) : capacity_(capacity) {}

  void push(InputMessage message);

  /// Waits for a message; empty once the queue is closed.
  std::optional<InputMessage> pop();

  /// Wakes the worker for good. Messages that still wait are given up.
  void close();

  /// Messages that wait now.
  std::size_t length() const;

  std::size_t dropped() const;

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<InputMessage> messages_;
  std::size_t dropped_ = 0;
  bool is_closed_ = false;
};

}  // namespace semantic_mht_slam
