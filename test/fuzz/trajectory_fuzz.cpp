#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"

namespace semantic_mht_slam {

FuzzTarget trajectoryTarget() {
  const auto run = [](const std::string& bytes) {
    const FuzzedFile file(bytes);
    readOrRefuse([&] { readKittiTrajectory(file.path()); });
    readOrRefuse([&] { readTumTrajectory(file.path()); });
    readOrRefuse([&] { readTimes(file.path()); });
    readOrRefuse([&] { readCalibration(file.path()); });
  };
  return {"trajectory",
          run,
          {"1 0 0 0 0 1 0 0 0 0 1 0\n", "0.1 1 2 3 0 0 0 1\n# t x y z\n0.2 1 2 3 0 0 0 1\n", "0.1\n1e-1\n",
           "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n"}};
}

}  // namespace semantic_mht_slam
