// A scan and its labels: four in five of the bytes are points, the others labels.
#include <cstring>

#include "semantic_mht_slam/io/scan_file.h"
#include "semantic_mht_slam/perception/cloud_extractor.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "support/extraction_classes.h"
#include "support/scans.h"

namespace semantic_mht_slam {
namespace {

std::string goodScan() {
  Rng rng(1);
  LabelledCloud cloud;
  addBox(cloud, {10.0, 5.0, 0.0}, {0.2, 0.2, 3.0}, 40, kPoleLabel, rng);
  addBox(cloud, {8.0, -4.0, -1.0}, {4.0, 1.8, 1.5}, 40, kMovingCarLabel, rng);
  std::string points;
  std::string labels;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float record[4] = {cloud.points_m[i].x(), cloud.points_m[i].y(), cloud.points_m[i].z(), 0.5F};
    const std::uint32_t label = cloud.labels[i];
    points.append(reinterpret_cast<const char*>(record), sizeof record);
    labels.append(reinterpret_cast<const char*>(&label), sizeof label);
  }
  return points + labels;
}

}  // namespace

FuzzTarget scanTarget() {
  const ExtractionConfig config{makeExtractionClasses()};
  const auto run = [config, labels = makeExtractionLabels()](const std::string& bytes) {
    const std::size_t scan_bytes = bytes.size() / 5 * 4;
    const FuzzedFile scan(bytes.substr(0, scan_bytes));
    const FuzzedFile label_file(bytes.substr(scan_bytes));
    return readOrRefuse(
        [&] { extractObjects(readLabelledScan(scan.path(), label_file.path()), labels, config).detections(); });
  };
  return {"scan", run, {goodScan()}};
}

}  // namespace semantic_mht_slam
