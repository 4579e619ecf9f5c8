#include "semantic_mht_slam/ros/doctor.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/ros/diagnosis.h"

namespace semantic_mht_slam {
namespace {

using diagnostic_msgs::DiagnosticStatus;

DiagnosticStatus makeStatus(const std::string& part, unsigned char level, const std::string& message,
                            const std::map<std::string, std::string>& values) {
  DiagnosticStatus status;
  status.name = "slam_node: " + part;
  status.level = level;
  status.message = message;
  for (const auto& [key, value] : values) {
    status.values.emplace_back();
    status.values.back().key = key;
    status.values.back().value = value;
  }
  return status;
}

SystemObservation wellSystem() {
  SystemObservation system;
  system.has_master = true;
  system.node = "/slam_node";
  system.is_node_registered = true;
  system.type_of_topic = {{"/odometry", "nav_msgs/Odometry"}};
  system.diagnostics = {makeStatus("clock", DiagnosticStatus::OK, "", {{"use_sim_time", "false"}}),
                        makeStatus("odometry", DiagnosticStatus::OK, "10.0 Hz", {{"topic", "/odometry"}}),
                        makeStatus("objects", DiagnosticStatus::OK, "9.0 Hz", {{"topic", "/objects"}})};
  return system;
}

std::string problemOf(const SystemObservation& system) {
  const auto problem = firstProblem(system);
  return problem ? problem->problem : "";
}

TEST(DoctorTest, WellSystemHasNoProblemAndItsRatesAreShown) {
  EXPECT_EQ(problemOf(wellSystem()), "");
  EXPECT_NE(summaryOf(wellSystem()).find("odometry: 10.0 Hz"), std::string::npos);
}

TEST(DoctorTest, NotesAreShownThoughTheyAreNoFault) {
  EXPECT_TRUE(notesOf(wellSystem()).empty());
  SystemObservation system = wellSystem();
  system.diagnostics[2] =
      makeStatus("objects", DiagnosticStatus::OK, "9.0 Hz", {{"topic", "/objects"}, {kNoteKey, "given in 'odom'"}});
  EXPECT_EQ(problemOf(system), "");
  EXPECT_EQ(notesOf(system), std::vector<std::string>{"given in 'odom'"});
}

TEST(DoctorTest, CausesAreNamedBeforeTheirEffects) {
  SystemObservation system = wellSystem();
  system.diagnostics[2] = makeStatus("objects", DiagnosticStatus::WARN, "objects fault", {{"topic", "/objects"}});
  EXPECT_EQ(problemOf(system), "objects fault");
  system.diagnostics[1] =
      makeStatus("odometry", DiagnosticStatus::ERROR, "odometry fault", {{"topic", "/odometry"}, {"messages", "3"}});
  EXPECT_EQ(problemOf(system), "odometry fault");
  system.clock_publishers = 1;
  EXPECT_EQ(problemOf(system), "/clock is published and use_sim_time is false");
  system.diagnostics.clear();
  EXPECT_NE(problemOf(system).find("says nothing"), std::string::npos);
  system.is_node_registered = false;
  EXPECT_EQ(problemOf(system), "the node /slam_node does not run");
  system.has_master = false;
  EXPECT_NE(problemOf(system).find("no ROS master"), std::string::npos);
}

TEST(DoctorTest, SimTimeWithoutClockAndChangedSimTimeAreNamed) {
  SystemObservation system = wellSystem();
  system.use_sim_time = true;
  system.diagnostics[1].values.emplace_back();
  system.diagnostics[1].values.back().key = "messages";
  system.diagnostics[1].values.back().value = "0";
  EXPECT_EQ(problemOf(system), "use_sim_time is true and nobody publishes /clock");
  system.clock_publishers = 1;
  EXPECT_NE(problemOf(system).find("changed after"), std::string::npos);
}

TEST(DoctorTest, ABagThatIsOverIsNoProblem) {
  SystemObservation system = wellSystem();
  system.use_sim_time = true;
  system.diagnostics[0] = makeStatus("clock", DiagnosticStatus::OK, "stands still", {{"use_sim_time", "true"}});
  system.diagnostics[1] =
      makeStatus("odometry", DiagnosticStatus::OK, "0.0 Hz", {{"topic", "/odometry"}, {"messages", "600"}});
  EXPECT_EQ(problemOf(system), "");
  system.diagnostics[1].values[0].value = "0";  // "messages", the first by name
  EXPECT_EQ(problemOf(system), "use_sim_time is true and nobody publishes /clock");
}

TEST(DoctorTest, AnotherVersionOfTheMessagesIsNamed) {
  SystemObservation system = wellSystem();
  system.type_of_topic["/objects"] = "semantic_mht_slam/SemanticObjectArray";
  system.diagnostics[2] =
      makeStatus("objects", DiagnosticStatus::WARN, "no objects", {{"topic", "/objects"}, {"messages", "0"}});
  system.md5_of_topic["/objects"] = "0123456789abcdef";
  EXPECT_NE(problemOf(system).find("another version of semantic_mht_slam/SemanticObjectArray"), std::string::npos);
}

TEST(DoctorTest, SilentTopicIsAnsweredWithTopicsOfTheRightType) {
  SystemObservation system = wellSystem();
  system.diagnostics[1] = makeStatus("odometry", DiagnosticStatus::ERROR, "no odometry on /odometry",
                                     {{"topic", "/odometry"}, {"messages", "0"}});
  system.type_of_topic = {{"/laser_odom_to_init", "nav_msgs/Odometry"}, {"/rosout", "rosgraph_msgs/Log"}};
  ASSERT_TRUE(firstProblem(system));
  EXPECT_NE(firstProblem(system)->fix.find("odometry:=/laser_odom_to_init"), std::string::npos);
  system.type_of_topic = {{"/odometry", "geometry_msgs/PoseStamped"}};
  EXPECT_EQ(problemOf(system), "/odometry carries geometry_msgs/PoseStamped, expected is nav_msgs/Odometry");
  EXPECT_NE(firstProblem(system)->fix.find("odometry_relay pose_in:=/odometry"), std::string::npos);
  system.type_of_topic = {{"/odometry", "nav_msgs/Path"}};
  EXPECT_NE(firstProblem(system)->fix.find("rostopic find nav_msgs/Odometry"), std::string::npos);
}

TEST(DoctorTest, DetectionsOfAnotherTypeAreAnsweredWithTheRelay) {
  SystemObservation system = wellSystem();
  system.diagnostics[2] =
      makeStatus("objects", DiagnosticStatus::ERROR, "no objects on /boxes", {{"topic", "/boxes"}, {"messages", "0"}});
  system.type_of_topic = {{"/boxes", "jsk_recognition_msgs/BoundingBoxArray"}};
  EXPECT_EQ(problemOf(system),
            "/boxes carries jsk_recognition_msgs/BoundingBoxArray, expected is semantic_mht_slam/SemanticObjectArray");
  EXPECT_NE(firstProblem(system)->fix.find("object_relay.launch detections:=/boxes"), std::string::npos);
}

}  // namespace
}  // namespace semantic_mht_slam
