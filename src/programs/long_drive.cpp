#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <boost/program_options.hpp>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/SemanticObjectArray.h>

#include "semantic_mht_slam/app/simulated_dataset.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/stopwatch.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/simulation/simulator.h"

#include "program.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Simulates a scenario's drive, made again and again, and feeds it to the slam_node that runs, as fast as\n"
    "the node takes it: a frame's objects and odometry when the node has answered the frame before. Prints a row for\n"
    "each part of the drive: how long answers took, how far poses\n"
    "were off, and what the node says of its memory and map.\n"
    "  long_drive [--hours H] [--row H] [--scenario FILE] [--set KEY=VALUE ...] [--seed N]\n";

struct Arguments {
  std::string scenario = packageConfigFile("scenarios/town.yaml");
  std::vector<std::string> settings;
  std::uint64_t seed = 1;
  double hours = 8.0;
  double row_hours = 1.0;
};

po::options_description makeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("hours", po::value(&arguments.hours)->value_name("H"), "length of the drive; default: 8");
  add("row", po::value(&arguments.row_hours)->value_name("H"), "length of a part; default: 1");
  add("scenario", po::value(&arguments.scenario)->value_name("FILE"), "default: the package's scenarios/town.yaml");
  add("set", po::value(&arguments.settings)->value_name("KEY=VALUE")->composing(),
      "changes a key of the scenario; may be given several times");
  add("seed", po::value(&arguments.seed)->value_name("N"), "default: 1");
  return options;
}

/// The running node: what it is sent and what it answers. Needs a running spinner.
class FedNode {
 public:
  FedNode()
      : odometry_(handle_.advertise<nav_msgs::Odometry>("odometry", 10)),
        objects_(handle_.advertise<SemanticObjectArray>("objects", 10)),
        poses_(handle_.subscribe("pose", 10, &FedNode::notePose, this, ros::TransportHints().tcpNoDelay())),
        markers_(
            handle_.subscribe("markers/objects", 10, &FedNode::noteObjects, this, ros::TransportHints().tcpNoDelay())),
        diagnostics_(handle_.subscribe("/diagnostics", 10, &FedNode::noteDiagnostics, this)) {}

  void requireListening() const {
    constexpr double kLimit_s = 10.0;
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(kLimit_s);
    while (odometry_.getNumSubscribers() == 0 || objects_.getNumSubscribers() == 0 || poses_.getNumPublishers() == 0) {
      if (ros::WallTime::now() > deadline || !ros::ok()) throw InputError("no slam_node listens; start it first");
      ros::WallDuration(0.05).sleep();
    }
  }

  struct Answer {
    double time_ms = 0.0;
    Pose T_map_base;
  };

  /// Sends a frame and waits until its pose has come and its objects are taken in.
  Answer feed(Stamp stamp, const Pose& T_odom_base, const SemanticObjectArray& objects) {
    constexpr std::chrono::seconds kLimit(60);
    const nav_msgs::Odometry odometry = toOdometry({stamp, T_odom_base}, frames_.odom_frame, frames_.base_frame);
    const Stopwatch watch;
    objects_.publish(objects);
    odometry_.publish(odometry);
    std::unique_lock<std::mutex> lock(mutex_);
    if (!changed_.wait_for(lock, kLimit, [&] { return last_pose_ >= stamp && last_objects_ >= stamp; })) {
      throw InputError("the node has not answered for 60 s");
    }
    return {watch.elapsed_ms(), T_map_base_};
  }

  /// What the node says of its estimator after now.
  std::map<std::string, std::string> report() {
    constexpr std::chrono::seconds kLimit(60);
    std::unique_lock<std::mutex> lock(mutex_);
    const int before = reports_;
    changed_.wait_for(lock, kLimit, [&] { return reports_ > before + 1; });
    return report_;
  }

  const NodeConfig& frames() const { return frames_; }

 private:
  void notePose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_pose_ = toStamp(message->header.stamp);
    T_map_base_ = fromMessage(message->pose.pose);
    changed_.notify_all();
  }

  void noteObjects(const visualization_msgs::MarkerArrayConstPtr& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_objects_ = toStamp(message->markers.front().header.stamp);
    changed_.notify_all();
  }

  void noteDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
    const std::string name = ": estimator";
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& status : message->status) {
      const std::size_t length = status.name.size();
      if (length < name.size() || status.name.compare(length - name.size(), name.size(), name) != 0) continue;
      for (const auto& item : status.values) report_[item.key] = item.value;
      ++reports_;
    }
    changed_.notify_all();
  }

  ros::NodeHandle handle_;
  const NodeConfig frames_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Stamp last_pose_ = 0;
  Pose T_map_base_;
  Stamp last_objects_ = 0;
  int reports_ = 0;
  std::map<std::string, std::string> report_;
  ros::Publisher odometry_;
  ros::Publisher objects_;
  ros::Subscriber poses_;
  ros::Subscriber markers_;
  ros::Subscriber diagnostics_;
};

/// What is printed of a part of the drive.
struct Part {
  std::vector<double> times_ms;
  std::vector<double> errors_m;  ///< of the pose at once, from above
};

double quantile(std::vector<double> values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

void printHead() {
  std::printf("%9s %9s %9s %9s %9s %9s %9s %9s %9s %9s %9s\n", "drive (h)", "way (km)", "p50 (ms)", "p99 (ms)",
              "max (ms)", "off p50 m", "off p99 m", "MB", "landmarks", "submaps", "loops");
}

void printRow(double drive_s, double way_m, const Part& part, std::map<std::string, std::string> report) {
  std::printf("%9.2f %9.1f %9.2f %9.2f %9.1f %9.2f %9.2f %9s %9s %9s %9s\n", drive_s / 3600.0, way_m / 1000.0,
              quantile(part.times_ms, 0.5), quantile(part.times_ms, 0.99), quantile(part.times_ms, 1.0),
              quantile(part.errors_m, 0.5), quantile(part.errors_m, 0.99), report["resident memory (MB)"].c_str(),
              report["landmarks"].c_str(), report["submaps"].c_str(), report["loops"].c_str());
  std::fflush(stdout);
}

/// The drive of a scenario, at least `hours` long.
SimulatedDrive simulateRounds(Scenario scenario, double hours, const ClassTable& classes, std::uint64_t seed) {
  if (scenario.route.round_m == 0.0) scenario.route.round_m = scenario.route.length_m;
  scenario.route.length_m = 3600.0 * hours * scenario.route.cruise_speed_mps;
  return simulateDrive(scenario, classes, seed);
}

void feedDrive(const SimulatedDrive& drive, const ClassTable& classes, double hours, double row_hours, FedNode& node) {
  constexpr Stamp kOrigin = 1000000000;
  const double row_s = 3600.0 * row_hours;
  const auto frames = static_cast<std::size_t>(
      std::upper_bound(drive.stamps.begin(), drive.stamps.end(), stampFromSeconds(3600.0 * hours)) -
      drive.stamps.begin());
  Part part;
  double way_m = 0.0;
  double next_row_s = row_s;
  printHead();
  for (std::size_t k = 0; k < frames && ros::ok(); ++k) {
    const Stamp stamp = drive.stamps[k] + kOrigin;
    const FedNode::Answer answer = node.feed(stamp, drive.T_odom_base[k],
                                             toMessage(stamp, node.frames().base_frame, drive.detections[k], classes));
    part.times_ms.push_back(answer.time_ms);
    const Eigen::Vector3d off_m = answer.T_map_base.translation_m - drive.T_map_base[k].translation_m;
    part.errors_m.push_back(off_m.head<2>().norm());
    if (k > 0) way_m += (drive.T_map_base[k].translation_m - drive.T_map_base[k - 1].translation_m).norm();
    const double drive_s = secondsFromStamp(drive.stamps[k]);
    if (drive_s < next_row_s && k + 1 < frames) continue;
    printRow(drive_s, way_m, part, node.report());
    part = {};
    next_row_s += row_s;
  }
}

int run(int argc, char** argv) {
  ros::init(argc, argv, "long_drive");  // takes the arguments of ROS away
  Arguments arguments;
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, makeOptions(arguments))) return 0;
  if (!(arguments.hours > 0.0 && arguments.row_hours > 0.0)) throw InputError("--hours and --row must be above 0");
  if (!ros::master::check()) throw InputError("no ROS master: start slam_node first, with roslaunch or with roscore");
  FedNode node;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  node.requireListening();
  const ClassTable classes = readClassTable(packageConfigFile("classes_semantic_kitti.yaml"));
  const Scenario scenario = loadScenario(arguments.scenario, arguments.settings);
  const SimulatedDrive drive = simulateRounds(scenario, arguments.hours, classes, arguments.seed);
  feedDrive(drive, classes, arguments.hours, arguments.row_hours, node);
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("long_drive", [&] { return semantic_mht_slam::run(argc, argv); });
}
