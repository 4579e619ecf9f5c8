#include <atomic>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include "support/run_program.h"
#include "support/running_node.h"
#include "support/spinner.h"

namespace semantic_mht_slam {
namespace {

constexpr double kApart_m = 4.0;  // objects of RunningNode

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

/// Feeds a node in real time, stamped by this machine's clock, until it goes out of scope.
class Feeder {
 public:
  struct Habits {
    double objects_offset_s = 0.0;
    int class_id = RunningNode::kPole;
    std::string objects_frame = "base_link";
    bool sends_objects = true;
  };

  Feeder(RunningNode& node, const Habits& habits) : thread_([this, &node, habits] { feed(node, habits); }) {}
  ~Feeder() {
    is_over_ = true;
    thread_.join();
  }

 private:
  void feed(RunningNode& node, const Habits& habits) {
    const double begin_s = RunningNode::kBegin_s;
    while (!is_over_) {
      const double time_s = ros::WallTime::now().toSec() - begin_s;
      node.sendOdometry(time_s);
      if (habits.sends_objects) {
        const double stamp_s = time_s + habits.objects_offset_s;
        double back_m = std::fmod(std::abs(10.0 * stamp_s), kApart_m);  // a row of objects that stands
        if (habits.objects_frame == "odom") back_m -= RunningNode::wayAt_m(stamp_s);
        node.sendObjects(stamp_s, habits.class_id, 3, habits.objects_frame, back_m);
      }
      ros::WallDuration(0.05).sleep();
    }
  }

  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

ProgramResult askDoctor(const RunningNode& node, const std::string& arguments = "--seconds 3") {
  return runProgramOfPackage("doctor", "--node " + node.fullName() + " " + arguments);
}

void expectProblem(const ProgramResult& result, const std::string& problem, const std::string& fix) {
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_NE(result.output.find(problem), std::string::npos) << result.output;
  EXPECT_NE(result.output.find(fix), std::string::npos) << result.output;
}

TEST(DoctorRosTest, NoMasterAndNoNodeAreNamed) {
  expectProblem(runProgramOfPackage("doctor", "__master:=http://127.0.0.1:9"), "no ROS master at http://127.0.0.1:9",
                "ROS_MASTER_URI");
  expectProblem(runProgramOfPackage("doctor", "--node nobody"), "the node /nobody does not run", "start it");
}

TEST(DoctorRosTest, WellFedNodeIsWell) {
  RunningNode node("well");
  ASSERT_TRUE(node.isReady());
  const Feeder feeder(node, {});
  ros::WallDuration(1.0).sleep();
  const ProgramResult result = askDoctor(node);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("Hz on /well/odometry"), std::string::npos) << result.output;
}

TEST(DoctorRosTest, MissingInputIsNamed) {
  RunningNode node("hungry");
  ASSERT_TRUE(node.isReady());
  expectProblem(askDoctor(node, "--seconds 5"), "no odometry on /hungry/odometry", "fix");
  Feeder::Habits habits;
  habits.sends_objects = false;
  const Feeder feeder(node, habits);
  expectProblem(askDoctor(node), "no objects on /hungry/objects", "detector");
}

TEST(DoctorRosTest, StampsThirteenSecondsApartAreNamed) {
  for (const double offset_s : {13.0, -13.0}) {
    RunningNode node(offset_s > 0.0 ? "ahead" : "behind");
    ASSERT_TRUE(node.isReady());
    Feeder::Habits habits;
    habits.objects_offset_s = offset_s;
    const Feeder feeder(node, habits);
    ros::WallDuration(1.0).sleep();
    expectProblem(askDoctor(node), offset_s > 0.0 ? "s after the odometry" : "s before the odometry", "same clock");
  }
}

TEST(DoctorRosTest, UnconnectedFrameIsNamed) {
  RunningNode node("unconnected", {"_node/tf_timeout:=0.5"});
  ASSERT_TRUE(node.isReady());
  Feeder::Habits habits;
  habits.objects_frame = "nowhere";
  const Feeder feeder(node, habits);
  expectProblem(askDoctor(node, "--seconds 4"), "no transform from 'nowhere' to 'base_link'",
                "static_transform_publisher X Y Z YAW PITCH ROLL base_link nowhere");
}

TEST(DoctorRosTest, ObjectsInTheOdometrysFrameAreNoted) {
  RunningNode node("fixed");
  ASSERT_TRUE(node.isReady());
  Feeder::Habits habits;
  habits.objects_frame = "odom";
  const Feeder feeder(node, habits);
  ros::WallDuration(1.0).sleep();
  const ProgramResult result = askDoctor(node);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(result.output.find("all well"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("note: /fixed/objects is given in 'odom'"), std::string::npos) << result.output;
}

TEST(DoctorRosTest, UnmappedClassIsNamed) {
  RunningNode node("unmapped");
  ASSERT_TRUE(node.isReady());
  Feeder::Habits habits;
  habits.class_id = 99;
  const Feeder feeder(node, habits);
  expectProblem(askDoctor(node), "class id 99", "class_table");
}

TEST(DoctorRosTest, ClockOnWhileSimTimeIsOffIsNamedAndSoIsTheOpposite) {
  RunningNode node("clock");
  ASSERT_TRUE(node.isReady());
  {
    ros::NodeHandle handle;
    ros::Publisher clock = handle.advertise<rosgraph_msgs::Clock>("/clock", 1);
    expectProblem(askDoctor(node), "/clock is published and use_sim_time is false", "use_sim_time true");
  }
  ros::param::set("/use_sim_time", true);
  expectProblem(askDoctor(node), "use_sim_time is true and nobody publishes /clock", "--clock");
  ros::param::set("/use_sim_time", false);
}

TEST(DoctorRosTest, BadArgumentsEndWithCodeOne) {
  EXPECT_EQ(runProgramOfPackage("doctor", "--seconds 0").exit_code, 1);
  EXPECT_EQ(runProgramOfPackage("doctor", "--nonsense").exit_code, 1);
  EXPECT_EQ(runProgramOfPackage("doctor", "--help").exit_code, 0);
}

}  // namespace
}  // namespace semantic_mht_slam
