#pragma once

#include <vector>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/submap.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, MixtureComponent& component);
void transfer(StateArchive& archive, MixtureLandmark& landmark);
void transferAssociations(StateArchive& archive, std::vector<DetectionAssociation>& associations);
void transfer(StateArchive& archive, Submap& submap);

}  // namespace semantic_mht_slam
