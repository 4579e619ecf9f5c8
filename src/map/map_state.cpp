#include "semantic_mht_slam/map/map_state.h"

namespace semantic_mht_slam {
namespace {

bool areEqual(const Gaussian3& a, const Gaussian3& b) {
  return a.mean_m == b.mean_m && a.cov_m2 == b.cov_m2;
}

}  // namespace

void transfer(StateArchive& archive, MixtureComponent& component) {
  auto& [weight, position] = component;
  archive(weight, position);
}

void transfer(StateArchive& archive, MixtureLandmark& landmark) {
  auto& [id, components, position, class_probs, existence_prob, observations, first_submap, last_submap, merged_ids] =
      landmark;
  archive(id, components);
  // A landmark that nobody disputes has one component, which is all that is known of its place.
  bool is_as_component = components.size() == 1 && areEqual(components.front().position, position);
  archive(is_as_component);
  if (!is_as_component) archive(position);
  if (is_as_component && archive.isReading()) {
    if (components.empty()) StateArchive::fail("a landmark without a place");
    position = components.front().position;
  }
  archive(class_probs, existence_prob, observations, first_submap, last_submap, merged_ids);
}

void transferAssociations(StateArchive& archive, std::vector<DetectionAssociation>& associations) {
  const std::size_t count = archive.count(associations.size());
  if (archive.isReading()) associations.clear();
  DetectionAssociation last;
  for (std::size_t i = 0; i < count; ++i) {
    if (archive.isReading()) associations.emplace_back();
    auto& [frame, row, landmark] = associations[i];
    // Differences are small numbers, and alike from frame to frame; both are unsigned to wrap around.
    std::size_t frame_step = frame - last.frame;
    auto row_step = static_cast<std::int64_t>(row) - (frame_step == 0 ? last.row : 0);
    std::uint64_t landmark_step = landmark - last.landmark;
    archive(frame_step, row_step, landmark_step);
    frame = last.frame + frame_step;
    row = static_cast<int>(row_step + (frame_step == 0 ? last.row : 0));
    landmark = last.landmark + landmark_step;
    last = {frame, row, landmark == kNoLandmark ? last.landmark : landmark};
  }
}

void transfer(StateArchive& archive, MergedLandmark& merged_landmark) {
  auto& [merged, survivor] = merged_landmark;
  archive(merged, survivor);
}

void transfer(StateArchive& archive, MapAlignment& alignment) {
  auto& [T_earlier_submap, cov, weight, matches, is_accepted] = alignment;
  archive(T_earlier_submap, cov, weight, matches, is_accepted);
}

void transfer(StateArchive& archive, Submap& submap) {
  auto& [index, begin, end, T_odom_submap, landmarks, associations, merged, alignment] = submap;
  archive(index, begin, end, T_odom_submap, landmarks);
  transferAssociations(archive, associations);
  archive(merged, alignment);
}

}  // namespace semantic_mht_slam
