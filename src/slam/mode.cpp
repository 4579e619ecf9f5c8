#include "semantic_mht_slam/slam/mode.h"

namespace semantic_mht_slam {

const Localizer* localizerOf(const Mode& mode) {
  if (const auto* localizing = std::get_if<Localizing>(&mode)) return &localizing->localizer;
  if (const auto* following = std::get_if<Following>(&mode)) return &following->localizer;
  return nullptr;
}

Localizer* localizerOf(Mode& mode) {
  if (auto* localizing = std::get_if<Localizing>(&mode)) return &localizing->localizer;
  if (auto* following = std::get_if<Following>(&mode)) return &following->localizer;
  return nullptr;
}

bool isLocalizing(const Mode& mode) {
  return std::holds_alternative<Localizing>(mode);
}

bool isFollowing(const Mode& mode) {
  return std::holds_alternative<Following>(mode);
}

bool isLocated(const Mode& mode) {
  const Localizer* localizer = localizerOf(mode);
  return localizer == nullptr || localizer->isLocated();
}

}  // namespace semantic_mht_slam
