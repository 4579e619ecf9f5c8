#include "semantic_mht_slam/io/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  const std::string reason = std::strerror(errno);
  throw InputError(what + " '" + path + "': " + reason);
}

void writeAll(int file, std::string_view content, const std::string& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write", path);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Makes a rename durable.
void syncFolderOf(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const int handle = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (handle < 0) return;
  ::fsync(handle);
  ::close(handle);
}

void rename(const std::string& temporary, const std::string& path) {
  if (::rename(temporary.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    errno = reason;
    fail("cannot write", path);
  }
  syncFolderOf(path);
}

}  // namespace

std::string readFile(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw InputError("cannot read '" + path + "': it is a folder");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail("cannot read", path);
  std::ostringstream content;
  content << file.rdbuf();
  if (file.bad()) fail("cannot read", path);
  return content.str();
}

void forEachLine(std::string_view content, const std::function<void(int, std::string_view)>& use) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (content.substr(0, kByteOrderMark.size()) == kByteOrderMark) content.remove_prefix(kByteOrderMark.size());
  int number = 0;
  while (!content.empty()) {
    const std::size_t end = std::min(content.find('\n'), content.size());
    const std::string_view line = trimmed(content.substr(0, end));
    content.remove_prefix(std::min(end + 1, content.size()));
    ++number;
    if (!line.empty() && line.front() != '#') use(number, line);
  }
}

std::string at(const std::string& path, int line) {
  return path + ":" + std::to_string(line);
}

void requireReplaceable(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::symlink_status(path, error);
  const bool is_taken =
      status.type() != std::filesystem::file_type::not_found && status.type() != std::filesystem::file_type::none;
  if (is_taken && !std::filesystem::is_regular_file(status)) {
    throw InputError("cannot write '" + path + "': something else than a file is there");
  }
}

void writeFileAtomically(const std::string& path, std::string_view content) {
  requireReplaceable(path);
  const std::string temporary = path + ".tmp" + std::to_string(::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail("cannot write", path);
  try {
    writeAll(file, content, path);
    if (::fsync(file) != 0) fail("cannot write", path);
  } catch (...) {
    ::close(file);
    ::unlink(temporary.c_str());
    throw;
  }
  ::close(file);
  rename(temporary, path);
}

void moveIntoPlace(const std::string& temporary, const std::string& path) {
  const int file = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_synced = file >= 0 && ::fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) ::close(file);
  if (!is_synced) {
    ::unlink(temporary.c_str());
    errno = reason;
    fail("cannot write", path);
  }
  rename(temporary, path);
}

void prepareOutputFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError("cannot create folder '" + path + "': " + error.message());
  if (!std::filesystem::is_directory(path)) throw InputError("cannot write to '" + path + "': it is not a folder");
  if (::access(path.c_str(), W_OK | X_OK) != 0) fail("cannot write to folder", path);
}

}  // namespace semantic_mht_slam
