#include "semantic_mht_slam/io/scan_file.h"

#include <cstring>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kPointBytes = 16;
constexpr std::size_t kLabelBytes = 4;
constexpr std::uint32_t kClassMask = 0xFFFF;  // the high half is the instance

/// The content of a file of records of one size.
std::string readRecords(const std::string& path, std::size_t record_bytes, const std::string& what) {
  std::string content = readFile(path);
  if (content.size() % record_bytes != 0) {
    throw InputError(path + ": " + std::to_string(content.size()) + " bytes are no whole number of " + what + " of " +
                     std::to_string(record_bytes) + " bytes");
  }
  return content;
}

}  // namespace

LabelledCloud readScan(const std::string& scan_path) {
  const std::string content = readRecords(scan_path, kPointBytes, "points");
  LabelledCloud cloud;
  cloud.points_m.resize(content.size() / kPointBytes);
  for (std::size_t i = 0; i < cloud.points_m.size(); ++i) {
    std::memcpy(cloud.points_m[i].data(), content.data() + i * kPointBytes, 3 * sizeof(float));
  }
  return cloud;
}

LabelledCloud readLabelledScan(const std::string& scan_path, const std::string& labels_path) {
  LabelledCloud cloud = readScan(scan_path);
  const std::string content = readRecords(labels_path, kLabelBytes, "labels");
  const std::size_t labels = content.size() / kLabelBytes;
  if (labels != cloud.size()) {
    throw InputError(labels_path + ": " + std::to_string(labels) + " labels, but " + scan_path + " has " +
                     std::to_string(cloud.size()) + " points");
  }
  cloud.labels.resize(labels);
  for (std::size_t i = 0; i < labels; ++i) {
    std::uint32_t label = 0;
    std::memcpy(&label, content.data() + i * kLabelBytes, kLabelBytes);
    cloud.labels[i] = static_cast<std::uint16_t>(label & kClassMask);
  }
  return cloud;
}

}  // namespace semantic_mht_slam
