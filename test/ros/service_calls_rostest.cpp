// All services at once while a drive comes in at ten times its speed: each call is answered, and no message is lost.
#include <atomic>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <semantic_mht_slam/GetLandmarks.h>
#include <semantic_mht_slam/SetMode.h>

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

  /// True if the call is answered.
  bool call() {
    constexpr const char* kTriggers[] = {"finish_submap", "pause", "resume", "reset"};
    switch (const std::size_t which = rng_.index(8)) {
      case 0: {
        SaveMap::Request request;
        request.path = map_path_;
        return isAnswered<SaveMap>("save_map", request);
      }
      case 1: {
        LoadMap::Request request;
        request.path = map_path_;
        return isAnswered<LoadMap>("load_map", request);
      }
      case 2: {
        SetMode::Request request;
        request.mode = static_cast<std::uint8_t>(rng_.index(3));
        return isAnswered<SetMode>("set_mode", request);
      }
      case 3:
        return isAnswered<GetLandmarks>("get_landmarks", {});
      default:
        return isAnswered<std_srvs::Trigger>(kTriggers[which - 4], {});
    }
  }

 private:
  template <class Service>
  bool isAnswered(const std::string& name, typename Service::Request request) {
    typename Service::Response response;
    ros::ServiceClient client = handle_.serviceClient<Service>(name);
    return client.call(request, response) && !response.message.empty();
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
  std::atomic<int> answered{0};
  std::atomic<int> calling{kCallers};
  std::vector<std::thread> callers;
  for (int i = 0; i < kCallers; ++i) {
    callers.emplace_back([&, caller = Caller(driving.node.handle(), folder / "map.bag", i)]() mutable {
      while (left.fetch_sub(1) > 0) answered += caller.call() ? 1 : 0;
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
  EXPECT_EQ(answered, kCalls);
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
