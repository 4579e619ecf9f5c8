#include "semantic_mht_slam/map/side_by_side.h"

#include <algorithm>

namespace semantic_mht_slam {

void SideBySide::add(const std::vector<DetectionAssociation>& associations, const std::vector<NearLandmarks>& near) {
  for (const DetectionAssociation& association : associations) {
    if (association.landmark == kNoLandmark) continue;
    std::vector<std::size_t>& frames = frames_of_[association.landmark];
    if (frames.empty() || frames.back() < association.frame) frames.push_back(association.frame);
  }
  for (const auto& [a, b, frames] : near) near_frames_[{a, b}] += frames;
}

bool SideBySide::excludes(LandmarkId a, LandmarkId b) const {
  const auto of_a = frames_of_.find(a);
  const auto of_b = frames_of_.find(b);
  if (of_a == frames_of_.end() || of_b == frames_of_.end()) return false;
  const auto near = near_frames_.find({std::min(a, b), std::max(a, b)});
  int unexplained = near == near_frames_.end() ? 0 : -near->second;
  const std::vector<std::size_t>& in_b = of_b->second;
  auto frame = std::lower_bound(of_a->second.begin(), of_a->second.end(), in_b.front());
  auto other = std::lower_bound(in_b.begin(), in_b.end(), of_a->second.front());
  while (frame != of_a->second.end() && other != in_b.end()) {
    if (*frame == *other && ++unexplained > 0) return true;
    const bool is_behind = *frame <= *other;
    if (*other <= *frame) ++other;
    if (is_behind) ++frame;
  }
  return false;
}

bool SideBySide::excludes(const std::vector<LandmarkId>& names, const std::vector<LandmarkId>& others) const {
  return std::any_of(names.begin(), names.end(), [&](LandmarkId a) {
    return std::any_of(others.begin(), others.end(), [&](LandmarkId b) { return excludes(a, b); });
  });
}

}  // namespace semantic_mht_slam
