#include <atomic>

#include <gtest/gtest.h>

#include <semantic_mht_slam/GetMapUpdates.h>
#include <semantic_mht_slam/MapUpdate.h>

#include "support/driving_node.h"
#include "support/running_map_server.h"
#include "support/spinner.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

constexpr int kJoined = MapStatus::JOINED;

/// Another name of a robot, under which only every third of its updates comes.
class LossyLink {
 public:
  explicit LossyLink(const std::string& robot) : service_(robot + "/get_map_updates") {
    publisher_ = handle_.advertise<MapUpdate>("/lossy/map_update", 1000);
    server_ = handle_.advertiseService("/lossy/get_map_updates", &LossyLink::forward, this);
    subscriber_ = handle_.subscribe<MapUpdate>(
        robot + "/map_update", 1000, boost::function<void(const MapUpdateConstPtr&)>([this](const auto& update) {
          if (++came_ % 3 == 0) publisher_.publish(update);
        }));
  }

  int came() const { return came_; }
  int asked() const { return asked_; }

 private:
  bool forward(GetMapUpdates::Request& request, GetMapUpdates::Response& response) {
    ++asked_;
    GetMapUpdates call;
    call.request = request;
    if (!callService(service_, call)) return false;
    response = call.response;
    return true;
  }

  ros::NodeHandle handle_;
  std::string service_;
  std::atomic<int> came_ = 0;
  std::atomic<int> asked_ = 0;
  ros::Publisher publisher_;
  ros::ServiceServer server_;
  ros::Subscriber subscriber_;
};

/// Landmarks of the maps of two nodes by way of files.
std::size_t landmarksByFiles(DrivingNode& a, DrivingNode& b) {
  const TemporaryFolder folder;
  EXPECT_TRUE(a.save(folder / "a.bag").success && b.save(folder / "b.bag").success);
  RunningServer server("by_files", {"_server/folder:=" + folder.path()});
  EXPECT_TRUE(server.comesTo({{"a", kJoined}, {"b", kJoined}}));
  return server.status().landmarks;
}

void finish(DrivingNode& node) {
  EXPECT_TRUE(node.call<std_srvs::Trigger>("finish_submap").success);
}

TEST(RobotsOfMapServerTest, RobotsThatDriveBecomeOneMapThatIsThatOfTheirFiles) {
  DrivingNode first("robot_a");
  DrivingNode second("robot_b");
  ASSERT_TRUE(first.isReady() && second.isReady());
  ASSERT_TRUE(first.feed(0, 200)) << "the server comes later";
  RunningServer server("live", {"_server/robots:=/robot_a:/robot_b"});
  ASSERT_TRUE(server.comesTo({{"robot_a", kJoined}}));
  ASSERT_TRUE(first.feed(200, 400));
  ASSERT_TRUE(second.feed(680, 1100, 420));
  finish(first);
  finish(second);
  ASSERT_TRUE(server.comesTo([&](const MergeStatus& status) {
    return status.maps.size() == 2 && status.maps[0].state == kJoined && status.maps[1].state == kJoined &&
           status.maps[0].driven > 390.0 && status.maps[1].driven > 410.0;
  }));
  const auto by_files = static_cast<double>(landmarksByFiles(first, second));
  EXPECT_NEAR(server.status().landmarks, by_files, 0.02 * by_files);
  EXPECT_EQ(server.map("robot_a").source, "/robot_a/map_update");
}

TEST(RobotsOfMapServerTest, UpdatesThatAreLostAreAskedFor) {
  DrivingNode node("robot_c");
  ASSERT_TRUE(node.isReady());
  const LossyLink link("/robot_c");
  RunningServer server("lossy_server", {"_server/robots:=/lossy"});
  ASSERT_TRUE(node.feed(0, 500));
  finish(node);
  ASSERT_TRUE(server.comesTo([&](const MergeStatus& status) {
    return status.maps.size() == 1 && status.maps[0].state == kJoined && status.maps[0].driven > 490.0;
  }));
  EXPECT_GT(link.came(), 3);
  EXPECT_GT(link.asked(), 0);
}

TEST(RobotsOfMapServerTest, ARobotThatBeginsAnewKeepsItsFormerMap) {
  RunningServer server("patient", {"_server/robots:=/robot_d"});
  {
    DrivingNode node("robot_d");
    ASSERT_TRUE(node.isReady());
    ASSERT_TRUE(node.feed(0, 400));
    finish(node);
    ASSERT_TRUE(server.comesTo([](const MergeStatus& status) {
      return status.maps.size() == 1 && status.maps[0].state == kJoined && status.maps[0].driven > 390.0;
    }));
  }
  DrivingNode again("robot_d");
  ASSERT_TRUE(again.isReady());
  ASSERT_TRUE(again.feed(680, 1100, 420));
  finish(again);
  ASSERT_TRUE(server.comesTo({{"robot_d_before", kJoined}, {"robot_d", kJoined}}));
}

}  // namespace
}  // namespace semantic_mht_slam
