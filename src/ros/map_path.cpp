#include "semantic_mht_slam/ros/map_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/output_file.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

fs::path withHome(const std::string& path) {
  if (path.empty() || path.front() != '~') return path;
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0' || (path.size() > 1 && path[1] != '/')) {
    throw InputError("'" + path + "': only ~/ is known, the home of the node's user");
  }
  return fs::path(home) / fs::path(path.substr(std::min<std::size_t>(2, path.size())));
}

/// Symbolic links followed, as far as there is something.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path result = fs::weakly_canonical(path, error);
  if (error) throw InputError("'" + path.string() + "': " + error.message());
  return result.has_filename() ? result : result.parent_path();  // without a slash at the end
}

/// A path is text: a zero byte would end it early, and others would break the lines of whatever shows it.
void requirePrintable(const std::string& path) {
  const auto bad = std::find_if(path.begin(), path.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  if (bad == path.end()) return;
  throw InputError("the path holds the control character " + std::to_string(static_cast<unsigned char>(*bad)) +
                   ", after '" + std::string(path.begin(), bad) + "'");
}

/// The asked path, absolute, if it is inside of `map_folder`.
fs::path insidePath(const std::string& asked, const std::string& map_folder) {
  if (asked.empty()) throw InputError("the path is empty");
  requirePrintable(asked);
  const fs::path folder = withHome(map_folder);
  const fs::path given = withHome(asked);
  const fs::path path = absolutePath((given.is_absolute() ? given : folder / given).string());
  if (folder.empty()) return path;
  const fs::path inside = resolved(path);
  const fs::path root = resolved(folder);
  if (std::mismatch(root.begin(), root.end(), inside.begin(), inside.end()).first != root.end()) {
    throw InputError("'" + path.string() + "' is outside of '" + root.string() +
                     "' (node/map_folder), where files are read and written");
  }
  return path;
}

}  // namespace

std::string mapPath(const std::string& asked, const std::string& map_folder) {
  const fs::path path = insidePath(asked, map_folder);
  if (!path.has_filename()) throw InputError("'" + path.string() + "' names a folder, not a file");
  return path.string();
}

std::string resultsPath(const std::string& asked, const std::string& map_folder) {
  const fs::path path = insidePath(asked, map_folder);
  if (path == path.root_path()) throw InputError("'" + path.string() + "' is the root of the file system");
  return (path.has_filename() ? path : path.parent_path()).string();
}

}  // namespace semantic_mht_slam
