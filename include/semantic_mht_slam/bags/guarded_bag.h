#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <rosbag/bag.h>

namespace semantic_mht_slam {

/// A bag that any thread may open and close: rosbag loads a library with each bag and unloads it with the last, and
/// crashes where two threads do that at a time.
class GuardedBag {
 public:
  /// Throws rosbag::BagException.
  GuardedBag(const std::string& path, rosbag::bagmode::BagMode mode) {
    const std::lock_guard<std::mutex> lock(mutex());
    bag_ = std::make_unique<rosbag::Bag>();
    try {
      bag_->open(path, mode);
    } catch (...) {
      bag_.reset();
      throw;
    }
  }

  ~GuardedBag() {
    const std::lock_guard<std::mutex> lock(mutex());
    bag_.reset();
  }

  GuardedBag(const GuardedBag&) = delete;
  GuardedBag& operator=(const GuardedBag&) = delete;

  rosbag::Bag& operator*() { return *bag_; }
  rosbag::Bag* operator->() { return bag_.get(); }

  /// Gives up a bag that cannot be closed: it stays in memory.
  void leave() { static_cast<void>(bag_.release()); }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }

  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace semantic_mht_slam
