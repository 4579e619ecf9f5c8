#pragma once

#include <string>

namespace semantic_mht_slam {

/// The absolute path of a map file as somebody asks for it: "~/" is the home of the node's user, and a relative path
/// begins at `map_folder`, or where the node runs if that is empty. Throws InputError for an empty path, one that names
/// a folder, and, symbolic links followed, one outside of `map_folder`.
std::string mapPath(const std::string& asked, const std::string& map_folder);

/// The same for a folder of results.
std::string resultsPath(const std::string& asked, const std::string& map_folder);

}  // namespace semantic_mht_slam
