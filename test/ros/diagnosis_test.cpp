#include "semantic_mht_slam/ros/diagnosis.h"

#include <functional>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using Diagnose = void (*)(const NodeStatus&, const NodeStatus&, DiagnosticStatusWrapper&);

/// A node that works.
NodeStatus wellStatus() {
  NodeStatus status;
  status.odom_frame = "odom";
  status.base_frame = "base_link";
  status.class_table = "classes.yaml";
  status.running_s = 60.0;
  status.clock.time_s = 1000.0;
  status.odometry = {"/odometry", 1, 600, 10.0, 0.1, 1000000000000, 0.02};
  status.objects = {"/objects", 1, 600, 10.0, 0.1, 1000000000000, 0.05};
  status.queue_capacity = 2000;
  return status;
}

struct Fault {
  std::string name;
  Diagnose diagnose;
  unsigned char level;
  std::function<void(NodeStatus&)> cause;
  std::vector<std::string> named;  ///< parts of the message
};

class DiagnosisTest : public ::testing::TestWithParam<Fault> {};

TEST_P(DiagnosisTest, NamesTheFaultAndAFixAndIsOkWithoutIt) {
  const Fault& fault = GetParam();
  DiagnosticStatusWrapper well;
  fault.diagnose(wellStatus(), wellStatus(), well);
  EXPECT_EQ(well.level, DiagnosticStatus::OK) << well.message;

  NodeStatus status = wellStatus();
  fault.cause(status);
  DiagnosticStatusWrapper named;
  fault.diagnose(status, wellStatus(), named);
  EXPECT_EQ(named.level, fault.level);
  for (const std::string& part : fault.named) EXPECT_NE(named.message.find(part), std::string::npos) << named.message;
  ASSERT_FALSE(named.values.empty());
  EXPECT_EQ(named.values.front().key, kFixKey);
  EXPECT_FALSE(named.values.front().value.empty());
}

TEST_P(DiagnosisTest, WhatWasDroppedLongAgoIsNoFaultAnyMore) {
  NodeStatus status = wellStatus();
  const EstimatorStatus fresh = status.estimator;
  GetParam().cause(status);
  const bool is_about_drops =
      status.estimator.counters.odometry_invalid > fresh.counters.odometry_invalid ||
      status.queue_dropped_odometry > 0 || status.odometry.lost > 0 || status.objects.lost > 0 ||
      status.queue_dropped_objects > 0 || status.estimator.graph.failures > 0 ||
      !status.estimator.refused.unknown_classes.empty() || status.estimator.refused.objects_without_transform > 0;
  if (!is_about_drops) return;
  DiagnosticStatusWrapper later;
  GetParam().diagnose(status, status, later);
  EXPECT_EQ(later.level, DiagnosticStatus::OK) << later.message;
}

const std::vector<Fault> kFaults = {
    {"NoClock",
     diagnoseClock,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.clock.use_sim_time = true;
       s.clock.time_s.reset();
     },
     {"use_sim_time", "/clock"}},
    {"SimTimeOff",
     diagnoseClock,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.odometry.delay_s = 86400.0; },
     {"/odometry", "86400.0 s before"}},
    {"NoOdometry",
     diagnoseOdometry,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.odometry = {};
       s.odometry.topic = "/odometry";
     },
     {"no odometry on /odometry"}},
    {"SilentOdometry",
     diagnoseOdometry,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) { s.odometry.silent_s = 5.0; },
     {"no odometry", "5.0 s"}},
    {"WrongFrames",
     diagnoseOdometry,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.estimator.refused.odometry_wrong_frames = 3;
       s.estimator.refused.wrong_frames = "'camera_init' to 'camera'";
     },
     {"'camera_init' to 'camera'", "'odom' to 'base_link'"}},
    {"InvalidOdometry",
     diagnoseOdometry,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) { s.estimator.counters.odometry_invalid = 1; },
     {"quaternion"}},
    {"NoObjects",
     diagnoseObjects,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) {
       s.objects = {};
       s.objects.topic = "/objects";
     },
     {"no objects on /objects"}},
    {"SilentObjects",
     diagnoseObjects,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.objects.silent_s = 30.0; },
     {"no objects", "30.0 s"}},
    {"UnconnectedFrame",
     diagnoseObjects,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.estimator.refused.objects_without_transform = 1;
       s.estimator.refused.unconnected_frame = "nowhere";
     },
     {"'nowhere' to 'base_link'"}},
    {"StampsBehind",
     diagnoseObjects,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.estimator.counters.frames_before_odometry = 1;
       s.objects.delay_s = 13.0;
     },
     {"13.0 s before the odometry"}},
    {"StampsAhead",
     diagnoseObjects,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.estimator.counters.frames_far_ahead = 1;
       s.objects.delay_s = -13.0;
     },
     {"13.0 s after the odometry"}},
    {"UnknownClasses",
     diagnoseObjects,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) {
       s.estimator.refused.unknown_classes = {{7, 2}, {99, 1}};
     },
     {"class ids 7, 99", "classes.yaml"}},
    {"ZeroOdometryStamps",
     diagnoseOdometry,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) { s.estimator.refused.odometry_bad_stamps = 2; },
     {"/odometry is stamped zero"}},
    {"OneOdometryStampFarFromTheOthers",
     diagnoseOdometry,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.estimator.refused.odometry_stamp_outliers = 1; },
     {"single stamps far from the others"}},
    {"ZeroObjectStamps",
     diagnoseObjects,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) { s.estimator.refused.objects_bad_stamps = 2; },
     {"/objects is stamped zero"}},
    {"OneFailure",
     diagnoseEstimator,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.input_failures = {1, 0, "objects: no inverse"};
     },
     {"dropped a message", "objects: no inverse"}},
    {"FailureThatLasts",
     diagnoseEstimator,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.input_failures = {7, 3, "odometry: no inverse"};
     },
     {"stands still", "odometry: no inverse"}},
    {"FailureOfAService",
     diagnoseEstimator,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) {
       s.other_failures = {1, 1, "save_map: no memory"};
     },
     {"save_map: no memory"}},
    {"InitialPoseRefused",
     diagnoseEstimator,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) {
       s.estimator.initial_poses_refused = 1;
       s.estimator.initial_pose_problem = "its covariance is not finite";
     },
     {"initialpose", "its covariance is not finite"}},
    {"GraphFails",
     diagnoseEstimator,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) {
       s.estimator.graph = {3, "the solution is not finite"};
     },
     {"pose graph", "not finite"}},
    {"FullQueue", diagnoseQueue, DiagnosticStatus::WARN, [](NodeStatus& s) { s.queue_dropped_odometry = 5; }, {"full"}},
    {"SlowEstimator",
     diagnoseQueue,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.queue_dropped_objects = 5; },
     {"too slow", "oldest objects"}},
    {"LostOdometry",
     diagnoseOdometry,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.odometry.lost = 3; },
     {"/odometry are lost before they come here"}},
    {"LostObjects",
     diagnoseObjects,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.objects.lost = 3; },
     {"/objects are lost before they come here"}},
    {"OdometryJumps",
     diagnoseOdometry,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.estimator.odometry_jumps = 1; },
     {"/odometry jumps"}},
    {"OdometryInMillimetres",
     diagnoseOdometry,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.estimator.oddities.speed_m_per_s = 2000.0; },
     {"moves at 2000 m/s"}},
    {"ObjectsInMillimetres",
     diagnoseObjects,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.estimator.oddities.range_m = 20000.0; },
     {"20000 m away"}},
    {"CameraAxes",
     diagnoseObjects,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.estimator.oddities.height_m = 12.0; },
     {"12 m above 'base_link'"}},
    {"WorldCoordinates",
     diagnoseObjects,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) { s.estimator.oddities.moving_along = 0.9; },
     {"move along with the robot"}},
    {"Lost",
     diagnoseEstimator,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) {
       s.estimator.far_m = 33.0;
       s.estimator.lost_m = 400.0;
     },
     {"not found itself", "400 m"}},
    {"NoLandmarks",
     diagnoseEstimator,
     DiagnosticStatus::WARN,
     [](NodeStatus& s) {
       s.estimator.submaps = 4;
       s.estimator.driven_m = 240.0;
     },
     {"no landmark after 240 m"}},
    {"ObjectsInTheMap",
     diagnoseObjects,
     DiagnosticStatus::ERROR,
     [](NodeStatus& s) { s.estimator.refused.objects_in_map_frame = 5; },
     {"frame of the map"}},
};

INSTANTIATE_TEST_SUITE_P(Faults, DiagnosisTest, ::testing::ValuesIn(kFaults),
                         [](const auto& instance) { return instance.param.name; });

TEST(DiagnosisOfABagTest, ABagThatIsOverIsNoFaultNorIsTheSilenceAfterIt) {
  NodeStatus status = wellStatus();
  status.clock.use_sim_time = true;
  status.clock.still_s = 60.0;
  status.odometry.silent_s = 60.0;
  status.objects.silent_s = 60.0;
  for (const Diagnose diagnose : {diagnoseClock, diagnoseOdometry, diagnoseObjects}) {
    DiagnosticStatusWrapper after;
    diagnose(status, status, after);
    EXPECT_EQ(after.level, DiagnosticStatus::OK) << after.message;
  }
  DiagnosticStatusWrapper clock;
  diagnoseClock(status, status, clock);
  EXPECT_NE(clock.message.find("the bag is over"), std::string::npos) << clock.message;
}

TEST(FrameTimerTest, PercentilesAreThoseOfTheNewestThousand) {
  FrameTimer timer;
  EXPECT_EQ(timer.times().max_ms, 0.0);
  for (int i = 0; i < 5000; ++i) timer.add(1e6);
  for (int i = 1; i <= 1000; ++i) timer.add(i);
  EXPECT_NEAR(timer.times().mean_ms, 500.5, 1e-9);
  EXPECT_NEAR(timer.times().p99_ms, 990.0, 1.0);
  EXPECT_EQ(timer.times().max_ms, 1000.0);
}

}  // namespace
}  // namespace semantic_mht_slam
