#include <ros/ros.h>

#include "semantic_mht_slam/ros/object_extractor.h"
#include "semantic_mht_slam/ros/parameters.h"

#include "program.h"

namespace {

constexpr char kHelp[] =
    "Semantic objects from labelled clouds, or from label images with a cloud.\n"
    "  rosrun semantic_mht_slam object_extractor_node [_label_map:=FILE] [_source:=cloud|image] [_parameter:=value "
    "...]\n"
    "      [cloud:=/topic] [label_image:=/topic] [camera_info:=/topic] [objects:=/topic]\n"
    "The parameters are those of config/extraction.yaml; docs/parameters.md lists them.\n";

int run(int argc, char** argv) {
  using namespace semantic_mht_slam;
  if (printedHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "object_extractor");
  const ros::NodeHandle private_handle("~");  // the last handle that goes shuts logging down
  const ObjectExtractor extractor(ros::NodeHandle(), makeObjectExtractorSetup(readParameters(private_handle)));
  ros::spin();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("object_extractor_node", [&] { return run(argc, argv); });
}
