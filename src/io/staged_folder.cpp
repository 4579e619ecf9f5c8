#include "semantic_mht_slam/io/staged_folder.h"

#include <filesystem>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

/// Files below a folder, relative to it.
std::vector<fs::path> filesBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder));
  }
  return files;
}

}  // namespace

StagedFolder::StagedFolder(const std::string& path) : path_(path), was_made_here_(!fs::exists(path)) {
  prepareOutputFolder(path_);
  staging_ = (fs::path(path_) / (".partial." + std::to_string(::getpid()))).string();
  prepareOutputFolder(staging_);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;  // what cannot be cleaned up stays; the run has failed already
  fs::remove_all(staging_, ignored);
  if (was_made_here_ && !is_committed_) fs::remove_all(path_, ignored);
}

void StagedFolder::commit() {
  const std::vector<fs::path> files = filesBelow(staging_);
  for (const fs::path& file : files) {
    const fs::path target = fs::path(path_) / file;
    requireReplaceable(target.string());
  }
  for (const fs::path& file : files) {
    const fs::path target = fs::path(path_) / file;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (!error) fs::rename(fs::path(staging_) / file, target, error);
    if (error) throw InputError("cannot write '" + target.string() + "': " + error.message());
  }
  is_committed_ = true;
}

}  // namespace semantic_mht_slam
