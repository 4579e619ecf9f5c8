#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace semantic_mht_slam {

/// A mutex that is handed on in the order in which it was asked for: one thread that takes it again and again, as a
/// worker under load does, cannot keep a service waiting for ever.
class TicketMutex {
 public:
  void lock() {
    std::unique_lock<std::mutex> lock(mutex_);
    const std::uint64_t ticket = next_++;
    changed_.wait(lock, [&] { return ticket == serving_; });
  }

  void unlock() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++serving_;
    }
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_ = 0;
  std::uint64_t serving_ = 0;
};

}  // namespace semantic_mht_slam
