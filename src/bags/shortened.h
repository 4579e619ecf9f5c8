#pragma once

#include <nav_msgs/Path.h>

#include <semantic_mht_slam/SemanticMap.h>

namespace semantic_mht_slam {

/// What a map file holds for people and other programs, to whom most digits are noise, and most of what a number takes:
/// positions to 1/1024 m, the rest to four digits or more.
nav_msgs::Path shortened(nav_msgs::Path path);
SemanticMap shortened(SemanticMap map);

}  // namespace semantic_mht_slam
