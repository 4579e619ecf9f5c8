#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <opencv2/imgcodecs.hpp>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <semantic_mht_slam/GetLandmarks.h>
#include <semantic_mht_slam/SemanticObjectArray.h>

#include "semantic_mht_slam/models/labelled_cloud.h"
#include "semantic_mht_slam/ros/service_call.h"

#include "support/cloud_message.h"
#include "support/running_node.h"
#include "support/spinner.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

/// Lines "NAME: numbers" of a calibration file.
std::map<std::string, std::vector<double>> readLines(const std::string& path) {
  std::map<std::string, std::vector<double>> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    std::istringstream numbers(line.substr(colon + 1));
    lines[line.substr(0, colon)].assign(std::istream_iterator<double>(numbers), {});
  }
  return lines;
}

/// A frame of KITTI's object benchmark as ROS messages.
struct Sample {
  sensor_msgs::Image image;
  sensor_msgs::CameraInfo camera;
  sensor_msgs::PointCloud2 cloud;
  Pose T_cam_velodyne;
};

Sample readSample(const std::string& folder, const std::string& frame) {
  Sample sample;
  const cv::Mat pixels = cv::imread(folder + "/image_2/" + frame + ".png");
  sample.image.width = static_cast<std::uint32_t>(pixels.cols);
  sample.image.height = static_cast<std::uint32_t>(pixels.rows);
  sample.image.encoding = "bgr8";
  sample.image.step = 3 * sample.image.width;
  sample.image.data.assign(pixels.datastart, pixels.dataend);
  const auto lines = readLines(folder + "/calib/" + frame + ".txt");
  std::copy_n(lines.at("P2").begin(), 12, sample.camera.P.begin());
  sample.camera.width = sample.image.width;
  sample.camera.height = sample.image.height;
  Eigen::Matrix<double, 3, 4> velodyne =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(lines.at("Tr_velo_to_cam").data());
  const Eigen::Matrix3d rectified =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(lines.at("R0_rect").data());
  sample.T_cam_velodyne = Pose::fromMatrix(rectified * velodyne);
  LabelledCloud cloud;
  std::ifstream file(folder + "/velodyne/" + frame + ".bin", std::ios::binary);
  for (float point[4]; file.read(reinterpret_cast<char*>(point), sizeof(point));) {
    cloud.points_m.emplace_back(point[0], point[1], point[2]);
    cloud.labels.push_back(0);
  }
  sample.cloud = makeCloudMessage(cloud, "velodyne", ros::Time());
  return sample;
}

/// The folder of the data; empty where there is none.
std::string dataFolder() {
  const char* folder = std::getenv("SEMANTIC_MHT_SLAM_DATA");
  return folder == nullptr ? "" : folder;
}

TEST(NetworkTest, ImagesAndCloudsBecomeLandmarks) {
  const std::string network = dataFolder() + "/networks/espnet_8_kitti.onnx";
  if (dataFolder().empty() || !std::filesystem::exists(network)) GTEST_SKIP() << "no network in SEMANTIC_MHT_SLAM_DATA";
  Sample sample = readSample(dataFolder() + "/scans/kitti_object", "000001");
  RunningNode slam("seeing", {"_class_table:=classes_cityscapes.yaml"});
  const std::string space = "__ns:=/seeing";
  RosProcess segmentation("segmentation_node",
                          {"__name:=segmentation", space, "_model:=" + network, "_input_width:=1248",
                           "_input_height:=384", "_red_first:=false", "_scale:=1"});
  RosProcess extractor("object_extractor_node",
                       {"__name:=object_extractor", space, "_source:=image", "_label_map:=labels_cityscapes.yaml"});
  ASSERT_TRUE(slam.isReady());
  tf2_ros::StaticTransformBroadcaster transforms;
  transforms.sendTransform({toTransform({1, Pose::identity()}, "base_link", "velodyne"),
                            toTransform({1, sample.T_cam_velodyne.inverse()}, "velodyne", "camera")});
  ros::NodeHandle& handle = slam.handle();
  const ros::Publisher images = handle.advertise<sensor_msgs::Image>("image", 10);
  const ros::Publisher cameras = handle.advertise<sensor_msgs::CameraInfo>("camera_info", 10);
  const ros::Publisher clouds = handle.advertise<sensor_msgs::PointCloud2>("cloud", 10);
  const ros::Publisher odometry = handle.advertise<nav_msgs::Odometry>("odometry", 100);
  std::atomic<int> arrays{0};
  std::atomic<std::size_t> objects{0};
  const ros::Subscriber listener = handle.subscribe<SemanticObjectArray>(
      "objects", 10,
      boost::function<void(const SemanticObjectArrayConstPtr&)>([&](const SemanticObjectArrayConstPtr& m) {
        objects += m->objects.size();
        ++arrays;
      }));
  ASSERT_TRUE(waitFor(
      [&] {
        return odometry.getNumSubscribers() > 0 && listener.getNumPublishers() > 0 && images.getNumSubscribers() > 0 &&
               cameras.getNumSubscribers() > 0 && clouds.getNumSubscribers() > 0;
      },
      30.0));
  sample.image.header.frame_id = sample.camera.header.frame_id = "camera";
  const auto stand = [&](const ros::Time& stamp) {
    odometry.publish(toOdometry({toStamp(stamp), Pose::identity()}, "odom", "base_link"));
  };
  for (int i = 0; i < 6; ++i) {  // the vehicle stands
    const ros::Time stamp(100 + i);
    sample.image.header.stamp = sample.camera.header.stamp = sample.cloud.header.stamp = stamp;
    stand(stamp);
    images.publish(sample.image);
    cameras.publish(sample.camera);
    clouds.publish(sample.cloud);
    stand(stamp + ros::Duration(0.5));
    ASSERT_TRUE(waitFor([&] { return arrays == i + 1; }, 60.0)) << i;
  }
  EXPECT_GT(objects, 12U) << "in six equal frames";
  std_srvs::Trigger trigger;
  ASSERT_TRUE(callService(handle.resolveName("finish_submap"), trigger) && trigger.response.success)
      << trigger.response.message;
  GetLandmarks all;
  ASSERT_TRUE(callService(handle.resolveName("get_landmarks"), all) && all.response.success) << all.response.message;
  EXPECT_GE(all.response.landmarks.size(), 3U);
  for (const Landmark& landmark : all.response.landmarks) EXPECT_GT(landmark.position.x, 0.0) << "before the camera";
}

}  // namespace
}  // namespace semantic_mht_slam
