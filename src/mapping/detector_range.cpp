#include "semantic_mht_slam/mapping/detector_range.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/length.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kDetections = 30;  // enough, or
constexpr int kFrames = 20;              // so many frames that show something
constexpr double kQuantile = 0.9;
constexpr double kMostHalvings = 6.0;

}  // namespace

bool DetectorRange::add(const Detections& detections) {
  for (const Detection& detection : detections) ranges_m_.push_back(detection.position_m.head<2>().norm());
  if (!detections.empty()) ++frames_;
  return ranges_m_.size() >= kDetections || frames_ >= kFrames;
}

double DetectorRange::factor() const {
  if (ranges_m_.empty()) return 1.0;
  std::vector<double> ranges_m = ranges_m_;
  const auto place = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(ranges_m.size() - 1));
  std::nth_element(ranges_m.begin(), ranges_m.begin() + place, ranges_m.end());
  const double range_m = ranges_m[static_cast<std::size_t>(place)];
  if (!(range_m > 0.0)) return 1.0;
  const double doublings = std::log2(range_m / Length::kReferenceRange_m);
  return std::exp2(std::clamp(std::round(doublings), -kMostHalvings, kMostHalvings));
}

void DetectorRange::transfer(StateArchive& archive) {
  archive(ranges_m_, frames_);
  const bool are_ranges =
      std::all_of(ranges_m_.begin(), ranges_m_.end(), [](double range_m) { return range_m >= 0.0; });
  archive.require(are_ranges && frames_ >= 0, "a negative range");
}

}  // namespace semantic_mht_slam
