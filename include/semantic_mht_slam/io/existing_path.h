#pragma once

#include <cstdint>
#include <string>

namespace semantic_mht_slam {

/// Whether something may be at `path`, links followed: there is, or the system does not tell (links in a circle, a name
/// that is too long, a folder that may not be entered), which is for whoever reads it to report.
bool mayExist(const std::string& path);

/// Whether a folder is at `path`, links followed. No, if the system does not tell.
bool isFolder(const std::string& path);

/// Size in bytes of the regular file at `path`, links followed. Throws InputError naming the path and the reason if
/// there is none, or the system does not tell.
std::uint64_t sizeOfFile(const std::string& path);

/// Removes the folder at `path` and everything below it, as far as the system allows it.
void removeFolder(const std::string& path);

}  // namespace semantic_mht_slam
