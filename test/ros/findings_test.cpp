// Which of several findings is named, and that none is kept quiet.
#include <functional>

#include <gtest/gtest.h>

#include "semantic_mht_slam/ros/diagnosis.h"
#include "semantic_mht_slam/ros/doctor.h"

namespace semantic_mht_slam {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

/// A node that works.
NodeStatus statusOfAWorkingNode() {
  NodeStatus status;
  status.running_s = 60.0;
  status.clock.time_s = 1000.0;
  status.odometry = {"/odometry", 1, 600, 10.0, 0.1, 1000000000000, 0.02};
  status.objects = {"/objects", 1, 600, 10.0, 0.1, 1000000000000, 0.05};
  return status;
}

template <class Diagnosis>
DiagnosticStatus diagnosed(const Diagnosis& diagnose, const NodeStatus& now,
                           const NodeStatus& before = statusOfAWorkingNode()) {
  DiagnosticStatusWrapper status;
  diagnose(now, before, status);
  return status;
}

std::string valueWith(const DiagnosticStatus& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& value : status.values) {
    if (value.key == key) return value.value;
  }
  return {};
}

using Cause = std::function<void(NodeStatus&)>;

/// Each two of them at once: the first one is the cause.
void expectInOrder(void (*diagnose)(const NodeStatus&, const NodeStatus&, DiagnosticStatusWrapper&),
                   const std::vector<std::pair<std::string, Cause>>& causes) {
  for (std::size_t i = 0; i < causes.size(); ++i) {
    for (std::size_t j = i; j < causes.size(); ++j) {
      NodeStatus now = statusOfAWorkingNode();
      causes[j].second(now);
      causes[i].second(now);
      const std::string message = diagnosed(diagnose, now).message;
      EXPECT_NE(message.find(causes[i].first), std::string::npos) << message << "\nbeside: " << causes[j].first;
    }
  }
}

TEST(FindingsTest, OdometryInMillimetresAndLostMessagesAreCausesOfItsJumps) {
  expectInOrder(diagnoseOdometry,
                {{"single stamps far from", [](NodeStatus& s) { s.estimator.refused.odometry_stamp_outliers = 1; }},
                 {"stamps that do not rise", [](NodeStatus& s) { s.estimator.counters.odometry_not_rising = 1; }},
                 {"moves at 2000 m/s", [](NodeStatus& s) { s.estimator.oddities.speed_m_per_s = 2000.0; }},
                 {"are lost before they come", [](NodeStatus& s) { s.odometry.lost = 3; }},
                 {"no motion leads to", [](NodeStatus& s) { s.estimator.counters.odometry_outliers = 1; }},
                 {"/odometry jumps", [](NodeStatus& s) { s.estimator.odometry_jumps = 1; }}});
}

TEST(FindingsTest, StampsAreCausesOfMissingTransformsAndWorldCoordinatesOfObjectsFarAndHigh) {
  expectInOrder(diagnoseObjects,
                {{"is stamped zero", [](NodeStatus& s) { s.estimator.refused.objects_bad_stamps = 1; }},
                 {"after the odometry",
                  [](NodeStatus& s) {
                    s.estimator.counters.frames_far_ahead = 1;
                    s.objects.delay_s = -13.0;
                  }},
                 {"no transform", [](NodeStatus& s) { s.estimator.refused.objects_without_transform = 1; }},
                 {"at exactly 0, 0, 0", [](NodeStatus& s) { s.estimator.counters.detections_at_origin = 5; }},
                 {"move along with", [](NodeStatus& s) { s.estimator.oddities.moving_along = 0.9; }},
                 {"20000 m away", [](NodeStatus& s) { s.estimator.oddities.range_m = 20000.0; }},
                 {"40000 m above", [](NodeStatus& s) { s.estimator.oddities.height_m = 40000.0; }}});
}

TEST(FindingsTest, OdometryThatTheQueueDropsIsNoGapAndNoJumpOfTheOdometry) {
  NodeStatus now = statusOfAWorkingNode();
  now.estimator.odometry_jumps = 1;
  now.estimator.counters.frames_in_odometry_gap = 2;
  now.estimator.counters.frames_waiting_too_long = 2;
  EXPECT_EQ(diagnosed(diagnoseOdometry, now).level, DiagnosticStatus::WARN);
  EXPECT_EQ(diagnosed(diagnoseObjects, now).level, DiagnosticStatus::WARN);
  now.queue_dropped_odometry = 5;
  EXPECT_EQ(diagnosed(diagnoseOdometry, now).level, DiagnosticStatus::OK);
  EXPECT_EQ(diagnosed(diagnoseObjects, now).level, DiagnosticStatus::OK);
  EXPECT_EQ(diagnosed(diagnoseQueue, now).level, DiagnosticStatus::WARN);
}

TEST(FindingsTest, ObjectsWithoutAPositionAreAFaultIfTheyAreMostAndElseANote) {
  NodeStatus now = statusOfAWorkingNode();
  now.estimator.counters.detections_at_origin = 5;
  DiagnosticStatus status = diagnosed(diagnoseObjects, now);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "/objects holds objects at exactly 0, 0, 0 of their frame: dropped");
  EXPECT_NE(valueWith(status, kFixKey).find("leaves positions empty"), std::string::npos);
  EXPECT_EQ(valueWith(status, "objects dropped, at 0, 0, 0"), "5");
  EXPECT_EQ(valueWith(status, kNoteKey), "");
  EXPECT_EQ(diagnosed(diagnoseObjects, now, now).level, DiagnosticStatus::OK) << "that was long ago";

  now.estimator.counters.detections = 100;
  now.estimator.objects_fixed_frame = "odom";
  status = diagnosed(diagnoseObjects, now);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  SystemObservation system;
  system.diagnostics = {status};
  const std::vector<std::string> notes = notesOf(system);
  ASSERT_EQ(notes.size(), 2U) << "the other one is of the fixed frame";
  EXPECT_NE(notes[1].find("0, 0, 0"), std::string::npos) << notes[1];
}

TEST(FindingsTest, EveryCountOfTheInputIsShown) {
  using Counter = std::size_t InputCounters::*;
  for (const Counter counter :
       {&InputCounters::odometry, &InputCounters::odometry_invalid, &InputCounters::odometry_not_rising,
        &InputCounters::odometry_outliers, &InputCounters::frames, &InputCounters::frames_before_odometry,
        &InputCounters::frames_not_rising, &InputCounters::frames_far_ahead, &InputCounters::frames_in_odometry_gap,
        &InputCounters::frames_waiting_too_long, &InputCounters::detections, &InputCounters::detections_invalid,
        &InputCounters::detections_at_origin, &InputCounters::covariances_unknown, &InputCounters::frames_standing}) {
    NodeStatus now = statusOfAWorkingNode();
    now.estimator.counters.*counter = 471147;
    int shown = 0;
    for (const DiagnosticStatus& status : {diagnosed(diagnoseOdometry, now), diagnosed(diagnoseObjects, now)}) {
      for (const diagnostic_msgs::KeyValue& value : status.values) shown += value.value == "471147" ? 1 : 0;
    }
    EXPECT_EQ(shown, 1);
  }
}

TEST(FindingsTest, ManyUnknownClassesMakeNoLongStatus) {
  NodeStatus now = statusOfAWorkingNode();
  for (int id = 0; id < 65536; ++id) now.estimator.refused.unknown_classes[id] = 2;
  const DiagnosticStatus status = diagnosed(diagnoseObjects, now);
  EXPECT_EQ(status.message.rfind("class ids 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 and 65526 more on /objects", 0), 0U);
  EXPECT_EQ(valueWith(status, "objects of unknown class id 9"), "2");
  EXPECT_EQ(valueWith(status, "other unknown class ids"), "65526");
  EXPECT_EQ(valueWith(status, "objects of other unknown class ids"), "131052");
  EXPECT_LT(status.values.size(), 50U);
}

}  // namespace
}  // namespace semantic_mht_slam
