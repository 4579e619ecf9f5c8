#include "semantic_mht_slam/ros/topic_monitor.h"

#include <algorithm>
#include <utility>

namespace semantic_mht_slam {
namespace {

constexpr double kWindow_s = 10.0;
constexpr int kDenseRow = 10;
constexpr std::size_t kMostPublishers = 1000;

}  // namespace

void TopicMonitor::arrived(Stamp stamp, std::optional<Stamp> reference, double now_s) {
  if (status_.received == 0) begin_s_ = now_s;
  ++status_.received;
  status_.stamp = stamp;
  status_.delay_s.reset();
  if (reference) status_.delay_s = secondsFromStamp(*reference - stamp);
  arrivals_s_.push_back(now_s);
  while (arrivals_s_.front() < now_s - kWindow_s) arrivals_s_.pop_front();
}

void SequenceGaps::arrived(const std::string& publisher, std::uint32_t number) {
  if (publishers_.size() >= kMostPublishers) publishers_.clear();
  const auto [found, is_new] = publishers_.try_emplace(publisher);
  Publisher& known = found->second;
  const std::uint32_t before = std::exchange(known.newest, number);
  if (is_new) return;
  const std::uint32_t gap = std::exchange(known.gap, 0);
  if (number <= before) {
    known = {number, 0, false, 0};  // it began again, or the numbers are not one publisher's
    return;
  }
  lost_ += gap;
  known.in_a_row = number == before + 1 ? known.in_a_row + 1 : 0;
  known.is_dense = known.is_dense || known.in_a_row >= kDenseRow;
  if (known.is_dense) known.gap = number - before - 1;
}

TopicStatus TopicMonitor::status(double now_s) const {
  TopicStatus status = status_;
  if (arrivals_s_.empty()) return status;
  status.silent_s = now_s - arrivals_s_.back();
  const auto recent = std::count_if(arrivals_s_.begin(), arrivals_s_.end(),
                                    [&](double arrival_s) { return arrival_s >= now_s - kWindow_s; });
  // Before the window is full, n messages span n - 1 periods.
  const double span_s = now_s - begin_s_;
  status.rate_hz = span_s >= kWindow_s ? static_cast<double>(recent) / kWindow_s
                   : span_s > 0.0      ? static_cast<double>(recent - 1) / span_s
                                       : 0.0;
  return status;
}

}  // namespace semantic_mht_slam
