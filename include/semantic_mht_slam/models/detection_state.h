#pragma once

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/models/frame.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, Detection& detection);
void transfer(StateArchive& archive, Frame& frame);

}  // namespace semantic_mht_slam
