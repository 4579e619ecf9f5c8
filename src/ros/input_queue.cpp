#include "semantic_mht_slam/ros/input_queue.h"

#include <utility>

namespace semantic_mht_slam {

void InputQueue::push(InputMessage message) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_closed_) return;
    if (messages_.size() == capacity_) {
      messages_.pop_front();
      ++dropped_;
    }
    messages_.push_back(std::move(message));
  }
  changed_.notify_one();
}

std::optional<InputMessage> InputQueue::pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return is_closed_ || !messages_.empty(); });
  if (is_closed_) return std::nullopt;
  InputMessage message = std::move(messages_.front());
  messages_.pop_front();
  return message;
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

std::size_t InputQueue::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

}  // namespace semantic_mht_slam
