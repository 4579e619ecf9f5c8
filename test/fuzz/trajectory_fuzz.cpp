#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "fuzz/fuzzed_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace semantic_mht_slam;
  const FuzzedFile file(data, size);
  readOrRefuse([&] { readKittiTrajectory(file.path()); });
  readOrRefuse([&] { readTumTrajectory(file.path()); });
  readOrRefuse([&] { readTimes(file.path()); });
  readOrRefuse([&] { readCalibration(file.path()); });
  return 0;
}
