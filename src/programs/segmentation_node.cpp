#include <ros/ros.h>

#include "semantic_mht_slam/ros/parameters.h"
#include "semantic_mht_slam/ros/segmentation.h"

#include "program.h"

namespace {

constexpr char kHelp[] =
    "Class ids of images by a segmentation network in ONNX format, which you bring.\n"
    "  rosrun semantic_mht_slam segmentation_node _model:=FILE.onnx [_label_map:=FILE] [_parameter:=value ...]\n"
    "      [image:=/topic] [label_image:=/topic] [label_preview:=/topic]\n"
    "docs/parameters.md lists the parameters.\n";

int run(int argc, char** argv) {
  using namespace semantic_mht_slam;
  if (printedHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "segmentation");
  const ros::NodeHandle private_handle("~");  // the last handle that goes shuts logging down
  SegmentationNodeConfig config;
  Fields fields;
  describe(config, fields);
  applySettings(readParameters(private_handle), fields);
  const Segmentation segmentation(ros::NodeHandle(), config);
  ros::spin();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("segmentation_node", [&] { return run(argc, argv); });
}
