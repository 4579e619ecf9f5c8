#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/ros_listener.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/tiny_network.h"

namespace semantic_mht_slam {
namespace {

/// Class ids of the test's network: red, green, blue. Their classes have these colours in the preview.
constexpr char kTable[] =
    "classes:\n"
    "  - {id: 0, name: red_thing, color: '#ff0010'}\n"
    "  - {id: 2, name: blue_thing, color: '#1000ff'}\n";

class SegmentationNodeTest : public ::testing::Test {
 protected:
  SegmentationNodeTest()
      : warnings_(handle_),
        images_(handle_.advertise<sensor_msgs::Image>("/image", 10)),
        labels_(handle_.subscribe<sensor_msgs::Image>(
            "/label_image", 10, [this](const sensor_msgs::ImageConstPtr& m) { label_image_ = *m; })),
        preview_(handle_.subscribe<sensor_msgs::Image>(
            "/label_preview", 10, [this](const sensor_msgs::ImageConstPtr& m) { preview_image_ = *m; })) {
    writeFileAtomically(folder_ / "tiny.onnx", toOnnx(makeColorNetwork()));
    writeFileAtomically(folder_ / "table.yaml", kTable);
    const std::string program = std::string(SMHT_PROGRAM_DIR) + "/segmentation_node";
    const std::string model = "_model:=" + folder_ / "tiny.onnx";
    const std::string table = "_label_map:=" + folder_ / "table.yaml";
    child_ = ::fork();
    if (child_ == 0) {
      ::execl(program.c_str(), program.c_str(), model.c_str(), table.c_str(), "__name:=segmentation_node", nullptr);
      ::_exit(127);
    }
  }
  ~SegmentationNodeTest() override {
    ::kill(child_, SIGINT);
    int status = 0;
    ::waitpid(child_, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the node did not end cleanly";
  }

  const TemporaryFolder folder_;
  ros::NodeHandle handle_;
  WarningListener warnings_;
  ros::Publisher images_;
  ros::Subscriber labels_;
  ros::Subscriber preview_;
  std::optional<sensor_msgs::Image> label_image_;
  std::optional<sensor_msgs::Image> preview_image_;
  pid_t child_ = -1;
};

TEST_F(SegmentationNodeTest, ImageBecomesClassIdsAndAPreviewInClassColours) {
  ASSERT_TRUE(spinUntil([&] {
    return images_.getNumSubscribers() > 0 && labels_.getNumPublishers() > 0 && preview_.getNumPublishers() > 0 &&
           warnings_.isConnected();
  }));
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(4.25);
  image.header.frame_id = "camera";
  image.width = 3;
  image.height = 2;
  image.encoding = "bgr8";
  image.step = 9;
  image.data = {0,   0, 200, 0, 200, 0, 200, 0, 0,     // red, green, blue
                200, 0, 0,   0, 200, 0, 0,   0, 200};  // blue, green, red
  ASSERT_TRUE(spinUntil([&] {
    images_.publish(image);
    return label_image_ && preview_image_;
  })) << warnings_.all();
  EXPECT_EQ(label_image_->header.stamp, image.header.stamp);
  EXPECT_EQ(label_image_->header.frame_id, "camera");
  EXPECT_EQ(label_image_->encoding, "mono8");
  EXPECT_EQ(label_image_->data, (std::vector<std::uint8_t>{0, 1, 2, 2, 1, 0}));
  EXPECT_EQ(preview_image_->encoding, "rgb8");
  EXPECT_EQ(preview_image_->data, (std::vector<std::uint8_t>{255, 0, 16, 0, 0, 0, 16, 0, 255,  //
                                                             16, 0, 255, 0, 0, 0, 255, 0, 16}));
  image.encoding = "32FC1";
  for (int i = 0; i < 3; ++i) images_.publish(image);
  EXPECT_TRUE(spinUntil([&] { return warnings_.count("/image: message skipped: field 'encoding' is '32FC1'") > 0; }))
      << warnings_.all();
}

TEST(SegmentationProgramTest, MissingAndBrokenNetworksEndTheNodeWithOneLine) {
  const ProgramResult result = runProgramOfPackage("segmentation_node", "_model:=/no/such.onnx __name:=broken");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("segmentation_node: cannot read the network '/no/such.onnx'"), std::string::npos)
      << result.output;
}

}  // namespace
}  // namespace semantic_mht_slam
