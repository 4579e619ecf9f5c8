#include "semantic_mht_slam/io/existing_path.h"

#include <filesystem>
#include <system_error>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {

bool mayExist(const std::string& path) {
  std::error_code error;
  return std::filesystem::status(path, error).type() != std::filesystem::file_type::not_found;
}

bool isFolder(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error);
}

std::uint64_t sizeOfFile(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  const bool is_told = status.type() != std::filesystem::file_type::none;
  if (is_told && !std::filesystem::is_regular_file(status)) {
    throw InputError("cannot read '" + path + "': no such file, or no regular one");
  }
  const std::uintmax_t size = is_told ? std::filesystem::file_size(path, error) : 0;
  if (error) throw InputError("cannot read '" + path + "': " + error.message());
  return size;
}

void removeFolder(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

}  // namespace semantic_mht_slam
