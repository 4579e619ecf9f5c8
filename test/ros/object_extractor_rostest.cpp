#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/SemanticObjectArray.h>

#include "support/cloud_message.h"
#include "support/ros_listener.h"
#include "support/scans.h"

namespace semantic_mht_slam {
namespace {

constexpr std::uint16_t kPole = 80;
constexpr std::uint16_t kMovingCar = 252;
constexpr std::uint16_t kCityscapesPole = 5;

/// Talks to one extractor by its namespace.
class Extractor {
 public:
  Extractor(ros::NodeHandle& handle, const std::string& name)
      : cloud_(handle.advertise<sensor_msgs::PointCloud2>(name + "/cloud", 10)),
        objects_(handle.subscribe<SemanticObjectArray>(
            name + "/objects", 10, [this](const SemanticObjectArrayConstPtr& m) { arrays.push_back(*m); })),
        markers_(handle.subscribe<visualization_msgs::MarkerArray>(
            name + "/markers/extracted_objects", 10,
            [this](const visualization_msgs::MarkerArrayConstPtr& m) { boxes.push_back(*m); })) {}

  bool isConnected() const {
    return cloud_.getNumSubscribers() > 0 && objects_.getNumPublishers() > 0 && markers_.getNumPublishers() > 0;
  }
  void publish(const sensor_msgs::PointCloud2& cloud) { cloud_.publish(cloud); }

  std::vector<SemanticObjectArray> arrays;
  std::vector<visualization_msgs::MarkerArray> boxes;

 private:
  ros::Publisher cloud_;
  ros::Subscriber objects_;
  ros::Subscriber markers_;
};

class ObjectExtractorNodeTest : public ::testing::Test {
 protected:
  ObjectExtractorNodeTest() : warnings_(handle_) {
    Rng rng(1);
    addBox(cloud_, {10.0, 2.0, 0.0}, {0.2, 0.2, 3.0}, 40, kPole, rng);
    addBox(cloud_, {15.0, -4.0, -1.0}, {4.0, 1.8, 1.5}, 900, kMovingCar, rng);
    addBox(cloud_, {10.0, -8.0, 0.0}, {0.2, 0.2, 3.0}, 80, kPole, rng);
  }

  void expectAnswer(Extractor& extractor, const ros::Time& stamp, std::size_t objects) {
    ASSERT_TRUE(spinUntil([&] { return !extractor.arrays.empty() && !extractor.boxes.empty(); })) << warnings_.all();
    const SemanticObjectArray& array = extractor.arrays.back();
    EXPECT_EQ(array.header.stamp, stamp);
    EXPECT_EQ(array.header.frame_id, "velodyne");
    ASSERT_EQ(array.objects.size(), objects);
    const visualization_msgs::MarkerArray& boxes = extractor.boxes.back();
    ASSERT_EQ(boxes.markers.size(), objects + 1);
    EXPECT_EQ(boxes.markers[0].action, visualization_msgs::Marker::DELETEALL);
    for (std::size_t i = 0; i < objects; ++i) {
      EXPECT_NEAR(boxes.markers[i + 1].pose.position.x, array.objects[i].position.x, 0.5);
      EXPECT_EQ(boxes.markers[i + 1].scale.z, array.objects[i].size.z);
    }
  }

  ros::NodeHandle handle_;
  WarningListener warnings_;
  LabelledCloud cloud_;
};

TEST_F(ObjectExtractorNodeTest, LabelledCloudBecomesObjectsAndBadOnesAreToldByTopicAndField) {
  Extractor extractor(handle_, "/by_cloud");
  ASSERT_TRUE(spinUntil([&] { return extractor.isConnected() && warnings_.isConnected(); }));
  const ros::Time stamp(12.5);
  const sensor_msgs::PointCloud2 good = makeCloudMessage(cloud_, "velodyne", stamp);
  extractor.publish(good);
  expectAnswer(extractor, stamp, 3);
  const std::vector<SemanticObject>& objects = extractor.arrays.back().objects;
  EXPECT_EQ(objects[0].class_id, 10);
  EXPECT_TRUE(objects[0].is_moving);
  EXPECT_EQ(objects[0].points, 900U);
  EXPECT_NEAR(objects[0].position.x, 15.0, 0.2);
  EXPECT_EQ(objects[1].class_id, 80);
  EXPECT_FALSE(objects[1].is_moving);
  EXPECT_NEAR(objects[1].size.z, 3.0, 0.3);
  EXPECT_NEAR(objects[1].score, 40.0 / 60.0, 1e-9);
  EXPECT_GT(objects[1].covariance[8], objects[1].covariance[0]) << "a pole is less certain along itself";

  std::map<std::string, sensor_msgs::PointCloud2> bad;
  bad["no field 'label'"] = good;
  bad["no field 'label'"].fields.pop_back();
  bad["no points"] = makeCloudMessage({}, "velodyne", stamp);
  bad["is_bigendian"] = good;
  bad["is_bigendian"].is_bigendian = 1;
  bad["field 'data'"] = good;
  bad["field 'data'"].data.pop_back();
  extractor.arrays.clear();
  for (const auto& [problem, message] : bad) {
    const std::string expected = problem;
    extractor.publish(message);
    EXPECT_TRUE(spinUntil([&] { return warnings_.count(expected) > 0; })) << expected << "\n" << warnings_.all();
    for (int i = 0; i < 3; ++i) extractor.publish(message);
  }

  LabelledCloud odd = cloud_;
  odd.points_m.emplace_back(std::nanf(""), 0.0F, 0.0F);
  odd.labels.push_back(kPole);
  odd.points_m.emplace_back(10.0F, 0.0F, 0.0F);
  odd.labels.push_back(12345);
  extractor.publish(makeCloudMessage(odd, "velodyne", stamp));
  EXPECT_TRUE(spinUntil([&] { return !extractor.arrays.empty(); })) << "the good points of a cloud are used";
  EXPECT_EQ(extractor.arrays.size(), 1U) << "no bad cloud has an answer";
  EXPECT_EQ(extractor.arrays[0].objects.size(), 3U);
  EXPECT_TRUE(spinUntil([&] { return warnings_.count("12345 (1 points)") == 1; })) << warnings_.all();
  EXPECT_TRUE(spinUntil([&] { return warnings_.count("1 points that are not finite") == 1; })) << warnings_.all();
  EXPECT_EQ(warnings_.count("/by_cloud/cloud"), static_cast<int>(bad.size()) + 2) << "each problem is told once\n"
                                                                                  << warnings_.all();
}

TEST_F(ObjectExtractorNodeTest, NodeletDoesTheSameWithItsOwnParameters) {
  Extractor extractor(handle_, "/by_nodelet");
  ASSERT_TRUE(spinUntil([&] { return extractor.isConnected(); }));
  const ros::Time stamp(3.0);
  extractor.publish(makeCloudMessage(cloud_, "velodyne", stamp));
  expectAnswer(extractor, stamp, 2);
  EXPECT_EQ(extractor.arrays.back().objects[1].points, 80U) << "the pole of 40 points is below min_points";
}

class ImageExtractorNodeTest : public ObjectExtractorNodeTest {
 protected:
  ImageExtractorNodeTest()
      : extractor_(handle_, "/by_image"),
        images_(handle_.advertise<sensor_msgs::Image>("/by_image/label_image", 10)),
        infos_(handle_.advertise<sensor_msgs::CameraInfo>("/by_image/camera_info", 10)) {}

  /// The pole stands in the middle of the image.
  void publish(double seconds, const std::string& encoding = "mono8") {
    const ros::Time stamp(seconds);
    LabelledCloud cloud;
    Rng rng(2);
    addBox(cloud, {10.0, 0.0, 0.0}, {0.2, 0.2, 3.0}, 60, 0, rng);
    extractor_.publish(makeCloudMessage(cloud, "velodyne", stamp + ros::Duration(0.02)));
    sensor_msgs::Image image;
    image.header.stamp = stamp;
    image.header.frame_id = "camera";
    image.width = 640;
    image.height = 480;
    image.encoding = encoding;
    image.step = 640;
    image.data.assign(640 * 480, 255);
    for (std::size_t row = 140; row < 340; ++row) {
      for (std::size_t column = 308; column < 332; ++column) image.data[row * 640 + column] = kCityscapesPole;
    }
    images_.publish(image);
    sensor_msgs::CameraInfo info;
    info.header = image.header;
    info.width = 640;
    info.height = 480;
    info.P = {500, 0, 320, 0, 0, 500, 240, 0, 0, 0, 1, 0};
    infos_.publish(info);
  }

  Extractor extractor_;
  ros::Publisher images_;
  ros::Publisher infos_;
};

TEST_F(ImageExtractorNodeTest, LabelImageWithCloudAndCameraBecomesObjectsOnceTheTransformIsKnown) {
  ASSERT_TRUE(spinUntil([&] {
    return extractor_.isConnected() && warnings_.isConnected() && images_.getNumSubscribers() > 0 &&
           infos_.getNumSubscribers() > 0;
  }));
  publish(1.0);
  publish(1.5);
  EXPECT_TRUE(spinUntil([&] { return warnings_.count("no transform from 'velodyne' to 'camera'") > 0; }))
      << warnings_.all();
  EXPECT_TRUE(extractor_.arrays.empty());

  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "velodyne";
  transform.child_frame_id = "camera";
  transform.transform.rotation.x = -0.5;
  transform.transform.rotation.y = 0.5;
  transform.transform.rotation.z = -0.5;
  transform.transform.rotation.w = 0.5;
  broadcaster.sendTransform(transform);
  double seconds = 2.0;
  ASSERT_TRUE(spinUntil([&] {
    publish(seconds += 0.5);
    return !extractor_.arrays.empty();
  })) << warnings_.all();
  const SemanticObjectArray& array = extractor_.arrays.back();
  EXPECT_EQ(array.header.frame_id, "velodyne");
  ASSERT_EQ(array.objects.size(), 1U);
  EXPECT_EQ(array.objects[0].class_id, kCityscapesPole);
  EXPECT_NEAR(array.objects[0].position.x, 10.0, 0.1);
  EXPECT_NEAR(array.objects[0].position.y, 0.0, 0.1);

  publish(seconds += 0.5, "rgb8");
  publish(seconds += 0.5, "rgb8");
  EXPECT_TRUE(spinUntil([&] {
    return warnings_.count("/by_image/label_image: message skipped: field 'encoding'") > 0;
  })) << warnings_.all();
}

}  // namespace
}  // namespace semantic_mht_slam
