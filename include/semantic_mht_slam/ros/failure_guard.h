#pragma once

#include <cstddef>
#include <exception>
#include <mutex>
#include <string>

namespace semantic_mht_slam {

/// Failures that nobody foresaw: exceptions that are no answer to bad input.
struct FailureStatus {
  std::size_t count = 0;
  std::size_t in_a_row = 0;  ///< of the newest tasks
  std::string newest;        ///< "handling odometry: what the exception said"

  /// As many in a row as show that going on is of no use.
  bool isLasting() const { return in_a_row >= 3; }
};

/// Keeps such failures from ending the process: the task is given up, counted and named. Thread-safe.
class FailureGuard {
 public:
  /// Runs `body`; false if it threw. `task` says what was being done.
  template <class Body>
  bool run(const std::string& task, const Body& body) {
    try {
      body();
    } catch (const std::exception& error) {
      note(task, error.what());
      return false;
    } catch (...) {
      note(task, "an exception without a text");
      return false;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.in_a_row = 0;
    return true;
  }

  FailureStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_;
  }

  /// Begins again after what failed was put in order; what was counted stays.
  void forgetRow() {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.in_a_row = 0;
  }

 private:
  void note(const std::string& task, const std::string& what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++status_.count;
    ++status_.in_a_row;
    status_.newest = task + ": " + what;
  }

  mutable std::mutex mutex_;
  FailureStatus status_;
};

}  // namespace semantic_mht_slam
