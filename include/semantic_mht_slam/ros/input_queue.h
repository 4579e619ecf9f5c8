#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <variant>

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/NavSatFix.h>

#include <semantic_mht_slam/SemanticObjectArray.h>

namespace semantic_mht_slam {

/// A message for the estimator.
using InputMessage =
    std::variant<nav_msgs::OdometryConstPtr, SemanticObjectArrayConstPtr, sensor_msgs::NavSatFixConstPtr>;

/// Bounded queue between the subscribers and the worker. What is too much for the worker is dropped and counted:
/// objects that have waited for too long, and when the queue is full the oldest fix, else the oldest objects, or the
/// oldest odometry if neither waits.
class InputQueue {
 public:
  using Clock = std::chrono::steady_clock;

  /// Objects wait for `max_wait` at most.
  InputQueue(std::size_t capacity, Clock::duration max_wait) : capacity_(capacity), max_wait_(max_wait) {}

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

  std::size_t droppedOdometry() const;
  std::size_t droppedObjects() const;
  std::size_t droppedFixes() const;

 private:
  struct Waiting {
    InputMessage message;
    Clock::time_point since;
    std::uint64_t number;  ///< in the order of arrival
  };

  static bool isObjects(const Waiting& waiting);
  static bool isFix(const Waiting& waiting);
  void makeRoom();
  void dropOverdue();

  const std::size_t capacity_;
  const Clock::duration max_wait_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> messages_;
  std::uint64_t next_number_ = 0;
  std::optional<std::uint64_t> in_hand_;  ///< that the worker handles
  std::size_t dropped_odometry_ = 0;
  std::size_t dropped_objects_ = 0;
  std::size_t dropped_fixes_ = 0;
  bool is_closed_ = false;
};

}  // namespace semantic_mht_slam
