#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "semantic_mht_slam/app/refused_input.h"
#include "semantic_mht_slam/ros/failure_guard.h"
#include "semantic_mht_slam/ros/input_plausibility.h"
#include "semantic_mht_slam/ros/topic_monitor.h"
#include "semantic_mht_slam/slam/map_graph.h"

namespace semantic_mht_slam {

/// What the node's worker knows of its input and of the estimator.
struct EstimatorStatus {
  InputCounters counters;
  GnssCounters fixes;
  bool is_map_placed = false;  ///< fixes determine where it is on the Earth
  RefusedInput refused;
  std::size_t initial_poses_refused = 0;
  std::string initial_pose_problem;       ///< of the newest one
  std::size_t objects_while_failing = 0;  ///< messages dropped because the estimator stands still
  std::size_t objects_while_paused = 0;   ///< messages that were not wanted
  std::size_t resets = 0;                 ///< new maps begun
  std::string method;
  std::string mode = "mapping";
  bool is_lost = false;  ///< where the vehicle is in the map is not known
  std::size_t hypotheses = 0;
  std::size_t landmarks = 0;  ///< of the finished submaps
  std::size_t submaps = 0;    ///< finished
  std::size_t loops = 0;      ///< accepted
  GraphStatus graph;
  InputOddities oddities;
  std::string objects_fixed_frame;  ///< in which the newest objects are given, if it does not move with the robot
  std::size_t odometry_jumps = 0;   ///< each begins a session
  double driven_m = 0.0;            ///< by the frames of the map
  double lost_m = 0.0;              ///< driven since the vehicle last knew where it is
  double far_m = 0.0;               ///< as far as the detector sees, about
};

/// Times that frames took, of the last 1000.
struct FrameTimes {
  double mean_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

/// Keeps the newest 1000 frame times.
class FrameTimer {
 public:
  void add(double time_ms);
  FrameTimes times() const;

 private:
  std::deque<double> times_ms_;
};

/// ROS time against wall time.
struct ClockStatus {
  bool use_sim_time = false;
  std::optional<double> time_s;  ///< ROS time; empty while nothing has come on /clock
  double still_s = 0.0;          ///< wall time since ROS time changed
};

/// All that diagnostics are made of.
struct NodeStatus {
  std::string odom_frame;
  std::string base_frame;
  std::string class_table;
  double odometry_history_s = 10.0;
  double running_s = 0.0;  ///< wall time since the node started
  ClockStatus clock;
  TopicStatus odometry;  ///< delay: of ROS time against the stamp
  TopicStatus objects;   ///< delay: of the newest odometry's stamp against the stamp
  EstimatorStatus estimator;
  std::size_t queue_length = 0;
  std::size_t queue_capacity = 0;
  std::size_t queue_dropped_odometry = 0;
  std::size_t queue_dropped_objects = 0;
  FailureStatus input_failures;  ///< of the worker, which handles the input
  FailureStatus other_failures;  ///< of services, timers and `initialpose`
  FrameTimes frame_times;
  double resident_mb = 0.0;
};

/// Resident memory of this process in MB; 0 if the system does not tell.
double residentMegabytes();

}  // namespace semantic_mht_slam
