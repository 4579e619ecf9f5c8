#pragma once

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, Detection& detection);

}  // namespace semantic_mht_slam
