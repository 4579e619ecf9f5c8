#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <rosbag/bag.h>

namespace semantic_mht_slam {

/// Lets `fill` write a bag, so that `path` is either the old file or the whole new one (`OutputFile`). Returns its size
/// in bytes. Throws InputError naming the path and the reason.
std::size_t writeBagAtomically(const std::string& path, const std::function<void(rosbag::Bag&)>& fill);

}  // namespace semantic_mht_slam
