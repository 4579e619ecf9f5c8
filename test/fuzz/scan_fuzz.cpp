// A scan and its labels: of every 20 bytes 16 are a point and 4 a label, points first; what is left over, if it is
// much, makes the file of the labels too long.
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
    const std::size_t points = bytes.size() / 20;
    const std::size_t rest = bytes.size() % 20;
    const FuzzedFile scan(bytes.substr(0, points * 16));
    const FuzzedFile label_file(bytes.substr(points * 16, points * 4 + (rest > 16 ? rest : 0)));
    return readOrRefuse(
        [&] { extractObjects(readLabelledScan(scan.path(), label_file.path()), labels, config).detections(); });
  };
  return {"scan", run, {goodScan()}};
}

}  // namespace semantic_mht_slam
