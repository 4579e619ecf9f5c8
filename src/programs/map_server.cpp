#include <ros/ros.h>

#include "semantic_mht_slam/ros/parameters.h"

#include "map_server_node.h"
#include "program.h"

namespace {

constexpr char kHelp[] =
    "Joins the maps of several drives or robots into one while they come: world/map, tf world -> NAME/map.\n"
    "  rosrun semantic_mht_slam map_server [_server/folder:=DIR] [_server/maps:=A.bag:B.bag] [_parameter:=value ...]\n"
    "The other parameters are those that the maps were made with; docs/map_server.md says more.\n";

int run(int argc, char** argv) {
  using namespace semantic_mht_slam;
  if (printedHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "map_server");
  const ros::NodeHandle private_handle("~");  // the last handle that goes shuts logging down
  MapServerSetup setup = makeMapServerSetup(readParameters(private_handle));
  const ClassTable classes = loadClassTable(setup.system, "");
  const SlamConfig slam_config = loadableSlamConfig(setup.system, "");
  const MapServerNode node(ros::NodeHandle(), private_handle, setup, slam_config, classes);
  ros::MultiThreadedSpinner(2).spin();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("map_server", [&] { return run(argc, argv); });
}
