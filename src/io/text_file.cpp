#include "semantic_mht_slam/io/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include <unistd.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/output_file.h"

namespace semantic_mht_slam {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  const std::string reason = std::strerror(errno);
  throw InputError(what + " '" + path + "': " + reason);
}

}  // namespace

std::string readFile(const std::string& path) {
  if (isFolder(path)) throw InputError("cannot read '" + path + "': it is a folder");
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
    const bool is_link = std::filesystem::is_symlink(status);
    throw InputError("cannot write '" + path + "': " + (is_link ? "a symbolic link" : "something else than a file") +
                     " is there");
  }
}

void writeFileAtomically(const std::string& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.commit();
}

void prepareOutputFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError("cannot create folder '" + path + "': " + error.message());
  if (!isFolder(path)) throw InputError("cannot write to '" + path + "': it is not a folder");
  if (::access(path.c_str(), W_OK | X_OK) != 0) fail("cannot write to folder", path);
}

}  // namespace semantic_mht_slam
