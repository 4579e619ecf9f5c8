#include "semantic_mht_slam/io/staged_folder.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/text_file.h"

#include "temporary_name.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStagingMark = ".partial-";

/// Files below a folder, relative to it.
std::vector<fs::path> filesBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const bool is_file = entry->is_regular_file(error);
    if (error) break;
    if (is_file) files.push_back(entry->path().lexically_relative(folder));
  }
  if (error) throw InputError("cannot read folder '" + folder.string() + "': " + error.message());
  return files;
}

[[noreturn]] void failToMake(const fs::path& folder, const std::string& reason) {
  throw InputError("cannot create folder '" + folder.string() + "': " + reason);
}

/// Makes a folder and its parents, those that there are not, and adds them to `made`.
void makeFolders(const fs::path& folder, std::vector<std::string>& made) {
  fs::path part;
  for (const fs::path& name : folder) {
    part /= name;
    std::error_code error;
    const fs::file_type type = fs::status(part, error).type();
    if (type == fs::file_type::directory) continue;
    if (type == fs::file_type::none) failToMake(folder, error.message());
    if (type != fs::file_type::not_found) failToMake(folder, "'" + part.string() + "' is not a folder");
    if (fs::create_directory(part, error)) made.push_back(part.string());
    if (error) failToMake(folder, error.message());
  }
}

/// The folder, locked for as long as the descriptor is open; -1 if somebody else has it, or it is none.
int lockFolder(const std::string& path) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0 || ::flock(folder, LOCK_EX | LOCK_NB) == 0) return folder;
  ::close(folder);
  return -1;
}

/// Removes what killed programs left; a folder in use is locked.
void removeStagingLeftIn(const fs::path& path) {
  for (const std::string& left_over : temporariesIn(path, kStagingMark)) {
    const int folder = lockFolder(left_over);
    if (folder < 0) continue;
    removeFolder(left_over);
    ::close(folder);
  }
}

}  // namespace

StagedFolder::StagedFolder(const std::string& path) : path_(path) {
  try {
    makeFolders(path_, made_);
    prepareOutputFolder(path_);
    removeStagingLeftIn(path_);
    makeStaging();
  } catch (...) {
    removeUnlessCommitted();
    throw;
  }
}

StagedFolder::~StagedFolder() {
  removeUnlessCommitted();
}

/// Fails, unlike `prepareOutputFolder`, if something is there already.
void StagedFolder::makeStaging() {
  const std::string staging = (fs::path(path_) / (kStagingMark + randomDigits())).string();
  if (::mkdir(staging.c_str(), 0777) != 0) failToMake(staging, std::strerror(errno));
  staging_ = staging;
  lock_ = lockFolder(staging_);
  if (lock_ < 0) failToMake(staging_, "somebody else took it");
}

/// What cannot be cleaned up stays; the run has failed already.
void StagedFolder::removeUnlessCommitted() noexcept {
  if (!staging_.empty()) removeFolder(staging_);
  if (lock_ >= 0) ::close(lock_);
  if (is_committed_) return;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) ::rmdir(folder->c_str());
}

void StagedFolder::commit() {
  const std::vector<fs::path> files = filesBelow(staging_);
  for (const fs::path& file : files) {
    const fs::path target = fs::path(path_) / file;
    requireReplaceable(target.string());
  }
  for (const fs::path& file : files) {
    const fs::path target = fs::path(path_) / file;
    makeFolders(target.parent_path(), made_);
    std::error_code error;
    fs::rename(fs::path(staging_) / file, target, error);
    if (error) throw InputError("cannot write '" + target.string() + "': " + error.message());
  }
  is_committed_ = true;
}

bool StagedFolder::isStaging(const std::string& name) {
  return isTemporaryName(name, kStagingMark);
}

}  // namespace semantic_mht_slam
