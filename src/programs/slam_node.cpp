#include "semantic_mht_slam/ros/slam_node.h"

#include <string>

#include <ros/ros.h>

#include "program.h"

namespace {

constexpr char kHelp[] =
    "The ROS node: semantic objects and odometry in, trajectory and tf map -> odom out.\n"
    "  rosrun semantic_mht_slam slam_node [_parameter:=value ...] [objects:=/topic] [odometry:=/topic]\n"
    "Parameters are those of config/kitti.yaml, as private parameters; docs/parameters.md lists them.\n";

int run(int argc, char** argv) {
  using namespace semantic_mht_slam;
  if (printedHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "slam_node");
  const ros::NodeHandle private_handle("~");  // the last handle that goes shuts logging down
  const auto node = makeSlamNode(ros::NodeHandle(), private_handle, "");
  ros::spin();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("slam_node", [&] { return run(argc, argv); });
}
