#include "semantic_mht_slam/ros/input_queue.h"

#include <algorithm>
#include <utility>

namespace semantic_mht_slam {

bool InputQueue::isObjects(const Waiting& waiting) {
  return std::holds_alternative<SemanticObjectArrayConstPtr>(waiting.message);
}

bool InputQueue::isFix(const Waiting& waiting) {
  return std::holds_alternative<sensor_msgs::NavSatFixConstPtr>(waiting.message);
}

void InputQueue::push(InputMessage message) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_closed_) return;
    if (messages_.size() == capacity_) makeRoom();
    messages_.push_back({std::move(message), Clock::now(), next_number_++});
  }
  changed_.notify_all();
}

void InputQueue::makeRoom() {
  auto dropped = std::find_if(messages_.begin(), messages_.end(), isFix);
  if (dropped == messages_.end()) dropped = std::find_if(messages_.begin(), messages_.end(), isObjects);
  if (dropped == messages_.end()) dropped = messages_.begin();
  ++(isObjects(*dropped) ? dropped_objects_ : isFix(*dropped) ? dropped_fixes_ : dropped_odometry_);
  messages_.erase(dropped);
}

void InputQueue::dropOverdue() {
  const Clock::time_point first = Clock::now() - max_wait_;
  while (!messages_.empty() && isObjects(messages_.front()) && messages_.front().since < first) {
    messages_.pop_front();
    ++dropped_objects_;
  }
}

std::optional<InputMessage> InputQueue::pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  in_hand_.reset();
  dropOverdue();
  changed_.notify_all();
  changed_.wait(lock, [this] { return is_closed_ || !messages_.empty(); });
  if (is_closed_) return std::nullopt;
  InputMessage message = std::move(messages_.front().message);
  in_hand_ = messages_.front().number;
  messages_.pop_front();
  return message;
}

void InputQueue::waitUntilHandled(const std::function<bool()>& keep_waiting) {
  constexpr std::chrono::milliseconds kAskAgain(50);
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t end = next_number_;
  const auto is_done = [&] {
    const bool is_in_hand = in_hand_ && *in_hand_ < end;
    return is_closed_ || (!is_in_hand && (messages_.empty() || messages_.front().number >= end));
  };
  while (!changed_.wait_for(lock, kAskAgain, is_done)) {
    if (!keep_waiting()) return;
  }
}

void InputQueue::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
}

std::size_t InputQueue::length() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return messages_.size();
}

std::size_t InputQueue::droppedOdometry() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_odometry_;
}

std::size_t InputQueue::droppedObjects() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_objects_;
}

std::size_t InputQueue::droppedFixes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_fixes_;
}

}  // namespace semantic_mht_slam
