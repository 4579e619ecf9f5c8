#include "semantic_mht_slam/bags/bag_limits.h"

#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <string_view>
#include <utility>

#include <rosbag/chunked_file.h>

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
constexpr char kMessage = 2;
constexpr char kIndex = 4;
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

/// Goes through the records of a bag from first to last.
class BagCheck {
 public:
  /// The index is followed only where there is a `keep_reading`: that decompresses the bag.
  BagCheck(const std::string& path, KeepReading keep_reading)
      : path_(path),
        size_(sizeOfFile(path)),
        file_(path, std::ios::binary),
        place_(kMagic.size()),
        keep_reading_(std::move(keep_reading)) {}

  void run() {
    std::string magic(kMagic.size(), ' ');
    file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (!file_ || magic != kMagic) throw InputError(path_ + ": truncated, or no map file at all");
    while (place_ < size_) take(next());
  }

 private:
  struct Record {
    std::string header;
    std::string data;
    char op() const {
      const std::string_view op = fieldOf(header, "op");
      return op.size() == 1 ? op[0] : '\0';
    }
  };

  [[noreturn]] void fail(const char* problem) const { throw InputError(path_ + ": damaged: " + problem); }

  std::string read(std::uint64_t most) {
    std::array<char, 4> bytes{};
    file_.read(bytes.data(), bytes.size());
    place_ += bytes.size();
    const std::uint64_t length = file_ ? numberAt(bytes.data()) : 0;
    if (!file_ || length > size_ - place_) throw InputError(path_ + ": the file is truncated");
    if (length > most) fail("a record without an end");
    std::string result(length, ' ');
    file_.read(result.data(), static_cast<std::streamsize>(length));
    place_ += length;
    return result;
  }

  Record next() {
    std::string header = read(kMostHeader);
    return {std::move(header), read(size_)};
  }

  void take(Record record) {
    if (record.op() == kChunk) {
      const std::string_view size = fieldOf(record.header, "size");
      if (size.size() != 4 || numberAt(size.data()) > mostContent(size_)) {
        fail("a chunk claims more content than there can be");
      }
      if (!keep_reading_) return;
      if (!keep_reading_()) throw InputError(path_ + ": reading was given up");
      connection_of_message_ = messagesOf(contentOf(record, numberAt(size.data())));
    } else if (record.op() == kIndex && keep_reading_) {
      checkIndex(record);
    }
  }

  /// Connections of the messages of a chunk, by their places in it.
  std::map<std::uint32_t, std::string> messagesOf(const std::string& content) const {
    std::map<std::uint32_t, std::string> result;
    const auto lengthAt = [&](std::size_t at) -> std::size_t {
      if (content.size() - at < 4 || numberAt(&content[at]) > content.size() - at - 4)
        fail("a chunk holds no messages");
      return numberAt(&content[at]);
    };
    for (std::size_t at = 0; at < content.size();) {
      const std::string_view header(&content[at] + 4, lengthAt(at));
      if (fieldOf(header, "op") == std::string_view(&kMessage, 1)) {
        result[static_cast<std::uint32_t>(at)] = fieldOf(header, "conn");
      }
      at += 4 + header.size();
      at += 4 + lengthAt(at);
    }
    return result;
  }

  /// rosbag's reader takes no const bytes.
  static std::string contentOf(Record& chunk, std::size_t size) {
    const std::string_view name = fieldOf(chunk.header, "compression");
    const auto compression = name == "bz2"   ? rosbag::compression::BZ2
                             : name == "lz4" ? rosbag::compression::LZ4
                                             : rosbag::compression::Uncompressed;
    std::string content(size, '\0');
    rosbag::ChunkedFile().decompress(
        compression, reinterpret_cast<std::uint8_t*>(content.data()), static_cast<unsigned int>(content.size()),
        reinterpret_cast<std::uint8_t*>(chunk.data.data()), static_cast<unsigned int>(chunk.data.size()));
    return content;
  }

  /// rosbag goes where the index says, and crashes where no message begins.
  void checkIndex(const Record& index) const {
    constexpr std::size_t kTime = 8;
    constexpr std::size_t kEntry = kTime + 4;
    if (index.data.size() % kEntry != 0) fail("an index that ends inside an entry");
    for (std::size_t at = 0; at < index.data.size(); at += kEntry) {
      const auto message = connection_of_message_.find(numberAt(&index.data[at + kTime]));
      if (message == connection_of_message_.end() || message->second != fieldOf(index.header, "conn")) {
        fail("its index leads to no message");
      }
    }
  }

  const std::string& path_;
  std::uint64_t size_;
  std::ifstream file_;
  std::uint64_t place_;
  KeepReading keep_reading_;
  std::map<std::uint32_t, std::string> connection_of_message_;  ///< of the chunk before
};

}  // namespace

std::uint64_t mostContent(std::uint64_t file_size) {
  return kSmall + kMostGrowth * file_size;
}

std::uint64_t mostMemory(std::uint64_t file_size) {
  return kSmallMade + kMostMade * file_size;
}

void requireSoundRecords(const std::string& path) {
  BagCheck(path, {}).run();
}

void requireSoundBag(const std::string& path, const KeepReading& keep_reading) {
  BagCheck(path, keep_reading).run();
}

}  // namespace semantic_mht_slam
