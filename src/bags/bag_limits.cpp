#include "semantic_mht_slam/bags/bag_limits.h"

#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/existing_path.h"

// The format: http://wiki.ros.org/Bags/Format/2.0
namespace semantic_mht_slam {
namespace {

// The content of maps of drives is 1.1 to 1.7 times the file, the lists that are made of it 6.4 times.
constexpr std::uint64_t kMostGrowth = 4;
constexpr std::uint64_t kSmall = 8U << 20U;  // of which a small bag may hold as much as it wants
constexpr std::uint64_t kMostMade = 12;
constexpr std::uint64_t kSmallMade = 32U << 20U;
constexpr std::uint64_t kMostHeader = 1U << 20U;
constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr char kChunk = 5;

std::uint32_t numberAt(const char* bytes) {
  std::array<unsigned char, 4> b{};
  std::memcpy(b.data(), bytes, b.size());
  return static_cast<std::uint32_t>(b[0]) | static_cast<std::uint32_t>(b[1]) << 8U |
         static_cast<std::uint32_t>(b[2]) << 16U | static_cast<std::uint32_t>(b[3]) << 24U;
}

/// Value of a field of a record's header; empty if there is none.
std::string_view fieldOf(std::string_view header, std::string_view name) {
  while (header.size() > 4) {
    const std::size_t length = numberAt(header.data());
    if (length > header.size() - 4) return {};
    const std::string_view field = header.substr(4, length);
    if (field.size() > name.size() && field.substr(0, name.size()) == name && field[name.size()] == '=') {
      return field.substr(name.size() + 1);
    }
    header.remove_prefix(4 + length);
  }
  return {};
}

}  // namespace

std::uint64_t mostContent(std::uint64_t file_size) {
  return kSmall + kMostGrowth * file_size;
}

std::uint64_t mostMemory(std::uint64_t file_size) {
  return kSmallMade + kMostMade * file_size;
}

void requireModestBag(const std::string& path) {
  const std::uint64_t size = sizeOfFile(path);
  std::ifstream file(path, std::ios::binary);
  std::string magic(kMagic.size(), ' ');
  file.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (!file || magic != kMagic) throw InputError(path + ": truncated, or no map file at all");
  std::uint64_t place = kMagic.size();
  const auto length = [&] {
    std::array<char, 4> bytes{};
    file.read(bytes.data(), bytes.size());
    place += bytes.size();
    const std::uint64_t number = file ? numberAt(bytes.data()) : 0;
    if (!file || number > size - place) throw InputError(path + ": the file is truncated");
    return number;
  };
  while (place < size) {
    const std::uint64_t header_length = length();
    if (header_length > kMostHeader) throw InputError(path + ": damaged: a record without an end");
    std::string header(header_length, ' ');
    file.read(header.data(), static_cast<std::streamsize>(header_length));
    place += header_length;
    const std::string_view op = fieldOf(header, "op");
    const std::string_view content = fieldOf(header, "size");
    const bool is_chunk = op.size() == 1 && op[0] == kChunk;
    if (is_chunk && (content.size() != 4 || numberAt(content.data()) > mostContent(size))) {
      throw InputError(path + ": damaged: a chunk claims more content than there can be");
    }
    place += length();
    file.seekg(static_cast<std::streamoff>(place));
  }
}

}  // namespace semantic_mht_slam
