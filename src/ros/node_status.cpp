#include "semantic_mht_slam/ros/node_status.h"

#include <algorithm>
#include <fstream>
#include <vector>

#include <unistd.h>

#include "semantic_mht_slam/evaluation/statistics.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kFrameTimes = 1000;

}  // namespace

void FrameTimer::add(double time_ms) {
  times_ms_.push_back(time_ms);
  if (times_ms_.size() > kFrameTimes) times_ms_.pop_front();
}

FrameTimes FrameTimer::times() const {
  std::vector<double> sorted(times_ms_.begin(), times_ms_.end());
  if (sorted.empty()) return {};
  std::sort(sorted.begin(), sorted.end());
  return {mean(sorted), sorted[(sorted.size() - 1) * 99 / 100], sorted.back()};
}

double residentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double total_pages = 0.0;
  double resident_pages = 0.0;
  file >> total_pages >> resident_pages;
  return file ? resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0) : 0.0;
}

}  // namespace semantic_mht_slam
