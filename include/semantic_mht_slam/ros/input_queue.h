#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
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

  /// Waits for a message; empty once the queue is closed. Who asks for the next message has handled the one before.
  std::optional<InputMessage> pop();

  /// Waits until all that was pushed before the call is handled or dropped, the queue is closed, or `keep_waiting`,
  /// which is asked now and then, says no.
  void waitUntilHandled(const std::function<bool()>& keep_waiting);

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
  std::size_t pushed_ = 0;
  std::size_t dropped_ = 0;
  std::size_t taken_ = 0;
  std::size_t handled_ = 0;
  bool is_closed_ = false;
};

}  // namespace semantic_mht_slam
