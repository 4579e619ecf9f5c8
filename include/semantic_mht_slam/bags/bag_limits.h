#pragma once

#include <cstdint>
#include <string>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {

/// What the content of a bag of that size may take in memory: compression does not make maps smaller by more.
std::uint64_t mostContent(std::uint64_t file_size);

/// What may be made in memory of a map in a file of that size.
std::uint64_t mostMemory(std::uint64_t file_size);

/// Throws InputError unless the records of a bag lie inside the file, and no chunk of it claims to hold more than
/// `mostContent`: rosbag takes the memory that a chunk claims.
void requireSoundRecords(const std::string& path);

/// That, and that its index leads to its messages: rosbag reads wherever the index says. Throws InputError too once
/// `keep_reading` says no, and rosbag::BagException where a chunk cannot be decompressed.
void requireSoundBag(const std::string& path, const KeepReading& keep_reading);

}  // namespace semantic_mht_slam
