#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "support/text_mutation.h"

namespace semantic_mht_slam {

FuzzTarget trajectoryTarget() {
  const auto run = [](const std::string& bytes) {
    const FuzzedFile file(bytes);
    bool is_taken = readOrRefuse([&] { readKittiTrajectory(file.path()); });
    is_taken |= readOrRefuse([&] { readTumTrajectory(file.path()); });
    is_taken |= readOrRefuse([&] { readTimes(file.path()); });
    is_taken |= readOrRefuse([&] { readCalibration(file.path()); });
    is_taken |= readOrRefuse([&] { readCamera(file.path()); });
    return is_taken;
  };
  return {"trajectory",
          run,
          {"1 0 0 0 0 1 0 0 0 0 1 0\n", "0.1 1 2 3 0 0 0 1\n# t x y z\n0.2 1 2 3 0 0 0 1\n", "0.1\n2e-1\n",
           "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n",
           "P2: 7e2 0 6e2 4e1 0 7e2 1e2 2e-1 0 0 1 3e-3\nR0_rect: 1 0 0 0 1 0 0 0 1\n"
           "Tr_velo_to_cam: 0 -1 0 0 0 0 -1 0 1 0 0 -.3\n"},
          mutatedText};
}

}  // namespace semantic_mht_slam
