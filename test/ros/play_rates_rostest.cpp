#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <semantic_mht_slam/SaveMap.h>

#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/ros/service_call.h"

#include "support/running_node.h"
#include "support/spinner.h"
#include "support/square_drive.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

constexpr int kFrames = 200;  // 20 s at the speed at which they were recorded

void writeSquareBag(const std::string& path, const ClassTable& classes) {
  const SquareDrive drive(4);
  Recording recording;
  for (int i = 0; i < kFrames; ++i) {
    recording.odometry.push_back({SquareDrive::stampAt(i), SquareDrive::odometryAt(i)});
    DetectorFrame frame{SquareDrive::stampAt(i) - 30000000, drive.detectionsAt(i)};
    for (Detection& detection : frame.detections) detection.class_index = *classes.findId(RunningNode::kPole);
    recording.detector_frames.push_back(frame);
  }
  writeBag(path, recording, classes, {}, {}, 1000000000);
}

/// Keeps as many threads busy as the machine has cores.
class BusyMachine {
 public:
  explicit BusyMachine(bool is_busy) {
    for (unsigned i = 0; is_busy && i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
      threads_.emplace_back([this] {
        while (!is_over_) ++work_;
      });
    }
  }
  ~BusyMachine() {
    is_over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> is_over_{false};
  std::atomic<std::size_t> work_{0};
  std::vector<std::thread> threads_;
};

/// The map file that a node writes at the end of a bag that was played into it.
std::string mapOfReplay(const std::string& bag, int rate, bool is_busy, const std::string& path) {
  const std::string name = "rate_" + std::to_string(rate) + (is_busy ? "_busy" : "");
  RunningNode node(name);
  if (!node.isReady()) return "not ready";
  const std::string command = "rosrun rosbag play --quiet --wait-for-subscribers --rate " + std::to_string(rate) +
                              " --topics /objects /odometry /tf_static --bags '" + bag + "' /objects:=/" + name +
                              "/objects /odometry:=/" + name + "/odometry > /dev/null";
  {
    const BusyMachine busy(is_busy);
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(node.comesToSay("odometry", "messages", std::to_string(kFrames)));
    EXPECT_TRUE(node.comesToSay("objects", "messages", std::to_string(kFrames)));
  }
  std_srvs::Trigger finish;
  EXPECT_TRUE(callService("/" + name + "/finish_submap", finish) && finish.response.success);
  SaveMap save;
  save.request.path = path;
  EXPECT_TRUE(callService("/" + name + "/save_map", save) && save.response.success) << save.response.message;
  EXPECT_TRUE(node.comesToSay("objects", "frames used", std::to_string(kFrames - 1))) << "all after the first odometry";
  return readFile(path);
}

TEST(PlayRatesTest, TheMapFileIsTheSameAtEveryPlayRateAndOnABusyMachine) {
  const TemporaryFolder folder;
  const std::string bag = folder / "square.bag";
  writeSquareBag(bag, loadClassTable(SystemConfig{}, ""));
  const std::string expected = mapOfReplay(bag, 1, false, folder / "1.bag");
  EXPECT_GT(expected.size(), 10000U) << "a map, not the file of an empty one";
  EXPECT_TRUE(mapOfReplay(bag, 5, false, folder / "5.bag") == expected) << "5x differs from 1x";
  EXPECT_TRUE(mapOfReplay(bag, 10, false, folder / "10.bag") == expected) << "10x differs from 1x";
  EXPECT_TRUE(mapOfReplay(bag, 10, true, folder / "10_busy.bag") == expected) << "10x under load differs from 1x";
}

}  // namespace
}  // namespace semantic_mht_slam
