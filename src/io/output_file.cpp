#include "semantic_mht_slam/io/output_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

#include "temporary_name.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".tmp-";

/// Removes what killed programs left; a file that is being written is locked.
void removeLeftOvers(const fs::path& path) {
  for (const std::string& left_over : temporariesIn(path.parent_path(), path.filename().string() + kMark)) {
    const int file = ::open(left_over.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(left_over.c_str());
    ::close(file);
  }
}

/// Makes a rename durable.
void syncFolder(const fs::path& folder) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;
  ::fsync(handle);
  ::close(handle);
}

}  // namespace

std::string absolutePath(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return error ? path : absolute.lexically_normal().string();
}

void OutputFile::fail() const {
  const int reason = errno;
  throw InputError("cannot write '" + path_ + "': " + std::strerror(reason));
}

OutputFile::OutputFile(const std::string& path) : path_(absolutePath(path)) {
  if (path.empty()) throw InputError("cannot write '': no file is named");
  requireReplaceable(path_);
  const fs::path folder = fs::path(path_).parent_path();
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    const std::string reason = error ? error.message() : "it is not a folder";
    throw InputError("cannot write '" + path_ + "': '" + folder.string() + "': " + reason);
  }
  removeLeftOvers(path_);
  temporary_ = path_ + kMark + randomDigits();
  file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file_ < 0) fail();
  ::flock(file_, LOCK_EX | LOCK_NB);
}

OutputFile::~OutputFile() {
  if (file_ < 0) return;
  ::unlink(temporary_.c_str());
  ::close(file_);
}

void OutputFile::write(std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file_, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFile::writeAllOf(int descriptor) {
  std::array<char, 1U << 16U> buffer{};
  if (::lseek(descriptor, 0, SEEK_SET) != 0) fail();
  while (true) {
    const ssize_t length = ::read(descriptor, buffer.data(), buffer.size());
    if (length < 0 && errno == EINTR) continue;
    if (length < 0) fail();
    if (length == 0) return;
    write({buffer.data(), static_cast<std::size_t>(length)});
  }
}

/// Mode and owner of the file that is replaced.
void OutputFile::takeOver() const {
  struct stat old {};
  if (::lstat(path_.c_str(), &old) != 0) return;
  struct stat own {};
  if (::fstat(file_, &own) != 0) fail();
  // Only root may give files away; who may not keeps the file, and passes the group on if it is one of his.
  const bool is_same = own.st_uid == old.st_uid && own.st_gid == old.st_gid;
  const bool is_given = is_same || ::fchown(file_, old.st_uid, old.st_gid) == 0;
  if (!is_given) static_cast<void>(!::fchown(file_, own.st_uid, old.st_gid));
  if (::fchmod(file_, old.st_mode & 0777U) != 0) fail();
}

std::size_t OutputFile::commit() {
  takeOver();
  struct stat own {};
  if (::fsync(file_) != 0 || ::fstat(file_, &own) != 0) fail();
  requireReplaceable(path_);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  ::close(file_);
  file_ = -1;
  syncFolder(fs::path(path_).parent_path());
  return static_cast<std::size_t>(own.st_size);
}

}  // namespace semantic_mht_slam
