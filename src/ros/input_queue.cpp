#include "semantic_mht_slam/ros/input_queue.h"

#include <chrono>
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
    ++pushed_;
  }
  changed_.notify_all();
}

std::optional<InputMessage> InputQueue::pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  handled_ = taken_;
  changed_.notify_all();
  changed_.wait(lock, [this] { return is_closed_ || !messages_.empty(); });
  if (is_closed_) return std::nullopt;
  InputMessage message = std::move(messages_.front());
  messages_.pop_front();
  ++taken_;
  return message;
}

void InputQueue::waitUntilHandled(const std::function<bool()>& keep_waiting) {
  constexpr std::chrono::milliseconds kAskAgain(50);
  std::unique_lock<std::mutex> lock(mutex_);
  const std::size_t until = pushed_;
  const auto is_done = [&] { return is_closed_ || handled_ + dropped_ >= until; };
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

std::size_t InputQueue::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

}  // namespace semantic_mht_slam
