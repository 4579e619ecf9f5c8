#pragma once

#include <functional>
#include <string>

#include <rosbag/bag.h>

namespace semantic_mht_slam {

/// Lets `fill` write a bag beside `path`, syncs it and renames it, so that `path` is either the old file or the whole
/// new one. Throws InputError naming `path` and the reason.
void writeBagAtomically(const std::string& path, const std::function<void(rosbag::Bag&)>& fill);

}  // namespace semantic_mht_slam
