// All services at once while a drive comes in at ten times its speed: each call is answered, and no message is lost.
#include <array>
#include <atomic>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <semantic_mht_slam/GetLandmarks.h>
#include <semantic_mht_slam/SetMode.h>

#include "semantic_mht_slam/ros/service_call.h"

#include "support/driving_node.h"
#include "support/spinner.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

constexpr int kCalls = 200;
constexpr int kCallers = 2;
constexpr double kFramePause_s = 0.01;  // frames are 0.1 s apart
constexpr int kMostWaiting = 400;       // messages; a node that is slower, by a sanitizer, gets them as it takes them

/// Calls services in random order.
class Caller {
 public:
  Caller(ros::NodeHandle handle, std::string map_path, int number)
      : handle_(std::move(handle)), map_path_(std::move(map_path)), rng_(Rng(4).fork("caller", number)) {}

  /// Empty if the call is answered, or its service and what came instead.
  std::string call() {
    constexpr const char* kTriggers[] = {"finish_submap", "pause", "resume", "reset"};
    switch (const std::size_t which = rng_.index(8)) {
      case 0: {
        SaveMap::Request request;
        request.path = map_path_;
        return fault<SaveMap>("save_map", request);
      }
      case 1: {
        LoadMap::Request request;
        request.path = map_path_;
        return fault<LoadMap>("load_map", request);
      }
      case 2: {
        SetMode::Request request;
        request.mode = static_cast<std::uint8_t>(rng_.index(3));
        return fault<SetMode>("set_mode", request);
      }
      case 3:
        return fault<GetLandmarks>("get_landmarks", {});
      default:
        return fault<std_srvs::Trigger>(kTriggers[which - 4], {});
    }
  }

 private:
  template <class Service>
  std::string fault(const std::string& name, typename Service::Request request) {
    Service call;
    call.request = request;
    if (!callService(handle_.resolveName(name), call)) return name + ": no answer\n";
    return call.response.message.empty() ? name + ": an answer without a message\n" : "";
  }

  ros::NodeHandle handle_;
  const std::string map_path_;
  Rng rng_;
};

TEST(ServiceCallsTest, EachOfTwoHundredIsAnsweredDuringADriveAtTenTimesItsSpeedAndNoMessageIsLost) {
  const TemporaryFolder folder;
  DrivingNode driving("stormy", {"_node/queue_size:=1000000", "_node/max_delay:=3600"});
  ASSERT_TRUE(driving.isReady());
  std::atomic<int> left{kCalls};
  std::array<std::string, kCallers> faults;
  std::atomic<int> calling{kCallers};
  std::vector<std::thread> callers;
  for (int i = 0; i < kCallers; ++i) {
    callers.emplace_back([&, i, caller = Caller(driving.node.handle(), folder / "map.bag", i)]() mutable {
      while (left.fetch_sub(1) > 0) faults[i] += caller.call();
      --calling;
    });
  }
  int frame = 0;
  for (; frame < 600 || calling > 0; ++frame) {
    waitFor([&] { return std::atoi(driving.node.value("queue", "waiting").c_str()) < kMostWaiting; });
    driving.send(frame);
    ros::WallDuration(kFramePause_s).sleep();
  }
  for (std::thread& caller : callers) caller.join();
  for (const std::string& fault : faults) EXPECT_EQ(fault, "");
  for (const char* part : {"odometry", "objects"}) {
    EXPECT_TRUE(waitFor([&] { return driving.node.value(part, "messages") == std::to_string(frame); }, 60.0)) << part;
    EXPECT_EQ(driving.node.value(part, "lost before they came"), "0") << part;
    EXPECT_EQ(driving.node.value("queue", std::string("dropped, ") + part), "0");
  }
  EXPECT_TRUE(waitFor([&] { return driving.node.value("queue", "waiting") == "0"; }, 120.0));
  EXPECT_EQ(driving.node.value("estimator", "unexpected failures of the input"), "0");
  EXPECT_EQ(driving.node.value("estimator", "unexpected failures of services and timers"), "0");
}

}  // namespace
}  // namespace semantic_mht_slam
