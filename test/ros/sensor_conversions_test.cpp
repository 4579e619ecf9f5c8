#include "semantic_mht_slam/ros/sensor_conversions.h"

#include <gtest/gtest.h>

#include "support/cloud_message.h"
#include "support/expect_input_error.h"

namespace semantic_mht_slam {
namespace {

const LabelledCloud kCloud{{{1.0F, 2.0F, 3.0F}, {-4.0F, 5.0F, 6.5F}, {7.0F, 8.0F, 9.0F}}, {80, 252, 300}};

sensor_msgs::PointCloud2 makeMessage() {
  return makeCloudMessage(kCloud, "velodyne", ros::Time(1.0));
}

/// A message with one more field behind the others.
sensor_msgs::PointCloud2 withField(std::uint8_t datatype, const std::vector<std::uint8_t>& bytes) {
  sensor_msgs::PointCloud2 message = makeMessage();
  message.fields.pop_back();
  message.fields.push_back(message.fields.back());
  message.fields.back().name = "label";
  message.fields.back().offset = 12;
  message.fields.back().datatype = datatype;
  for (std::size_t i = 0; i < 3; ++i) std::copy(bytes.begin(), bytes.end(), message.data.begin() + 20 * i + 12);
  return message;
}

TEST(CloudConversionTest, PointsAndTheLowHalvesOfLabelsArriveThroughPaddingAndRows) {
  sensor_msgs::PointCloud2 message = makeMessage();
  EXPECT_EQ(fromMessage(message, "label").points_m, kCloud.points_m);
  EXPECT_EQ(fromMessage(message, "label").labels, kCloud.labels);
  EXPECT_TRUE(fromMessage(message, "").labels.empty());
  message.height = 3;  // an organised cloud of one column with bytes between the rows
  message.width = 1;
  message.row_step = 24;
  std::vector<std::uint8_t> spread(72);
  for (std::size_t i = 0; i < 3; ++i) std::copy_n(message.data.begin() + 20 * i, 20, spread.begin() + 24 * i);
  message.data = spread;
  EXPECT_EQ(fromMessage(message, "label").points_m, kCloud.points_m);
  EXPECT_EQ(fromMessage(message, "label").labels, kCloud.labels);
}

TEST(CloudConversionTest, LabelsOfEveryIntegerTypeAndWholeFloatsAreRead) {
  using sensor_msgs::PointField;
  EXPECT_EQ(fromMessage(withField(PointField::UINT8, {200}), "label").labels[1], 200);
  EXPECT_EQ(fromMessage(withField(PointField::UINT16, {0x34, 0x12}), "label").labels[1], 0x1234);
  EXPECT_EQ(fromMessage(withField(PointField::INT32, {0x34, 0x12, 7, 0}), "label").labels[1], 0x1234);
  EXPECT_EQ(fromMessage(withField(PointField::FLOAT32, {0, 0, 0xA0, 0x42}), "label").labels[1], 80);
  expectInputError([] { fromMessage(withField(PointField::FLOAT32, {0, 0, 0xA1, 0x42}), "label"); }, {"'label'"});
  expectInputError([] { fromMessage(withField(PointField::FLOAT64, {0}), "label"); }, {"'label'", "float64"});
  expectInputError([] { fromMessage(withField(99, {0}), "label"); }, {"'label'", "datatype 99"});
}

TEST(CloudConversionTest, CoordinatesMayBeDoubles) {
  sensor_msgs::PointCloud2 message = makeMessage();
  message.fields.resize(3);
  message.width = 1;
  message.point_step = 24;
  message.row_step = 24;
  const double values[] = {1.5, -2.5, 3.25};
  std::memcpy(message.data.data(), values, sizeof(values));
  for (std::size_t i = 0; i < 3; ++i) {
    message.fields[i].datatype = sensor_msgs::PointField::FLOAT64;
    message.fields[i].offset = static_cast<std::uint32_t>(8 * i);
  }
  EXPECT_EQ(fromMessage(message, "").points_m, (std::vector<Eigen::Vector3f>{{1.5F, -2.5F, 3.25F}}));
}

TEST(CloudConversionTest, EachWayToBeWrongIsNamed) {
  const auto refuse = [](const std::function<void(sensor_msgs::PointCloud2&)>& spoil,
                         const std::vector<std::string>& parts) {
    sensor_msgs::PointCloud2 message = makeMessage();
    spoil(message);
    expectInputError([&] { fromMessage(message, "label"); }, parts);
  };
  refuse([](auto& m) { m.width = 0; }, {"no points"});
  refuse([](auto& m) { m.is_bigendian = 1; }, {"big-endian", "is_bigendian"});
  refuse([](auto& m) { m.fields.pop_back(); }, {"no field 'label'", "x, y, z"});
  refuse([](auto& m) { m.fields.clear(); }, {"no field 'x'", "no fields"});
  refuse([](auto& m) { m.fields[2].datatype = sensor_msgs::PointField::INT32; }, {"'z'", "float32"});
  refuse([](auto& m) { m.fields[1].count = 3; }, {"'y'", "3 values"});
  refuse([](auto& m) { m.fields[3].offset = 18; }, {"'label'", "point_step"});
  refuse([](auto& m) { m.fields[0].offset = 0xFFFFFFFF; }, {"'x'", "point_step"});
  refuse([](auto& m) { m.data.pop_back(); }, {"'data'", "59 bytes"});
  refuse([](auto& m) { m.row_step = 59; }, {"step"});
  refuse([](auto& m) { m.width = m.height = 0xFFFFFFFF; }, {"step"});
}

sensor_msgs::Image makeImage(const std::string& encoding, std::uint32_t bytes_per_pixel) {
  sensor_msgs::Image image;
  image.width = 3;
  image.height = 2;
  image.encoding = encoding;
  image.step = 3 * bytes_per_pixel + 1;  // a byte of padding
  for (std::size_t i = 0; i < image.step * 2; ++i) image.data.push_back(static_cast<std::uint8_t>(i));
  return image;
}

TEST(LabelImageConversionTest, NarrowAndWideIdsAreReadAndOthersAreNamed) {
  EXPECT_EQ(fromMessage(makeImage("mono8", 1)).labels, (std::vector<std::uint16_t>{0, 1, 2, 4, 5, 6}));
  EXPECT_EQ(fromMessage(makeImage("16UC1", 2)).labels,
            (std::vector<std::uint16_t>{0x0100, 0x0302, 0x0504, 0x0807, 0x0A09, 0x0C0B}));
  expectInputError([] { fromMessage(makeImage("rgb8", 3)); }, {"'encoding'", "'rgb8'"});
  sensor_msgs::Image image = makeImage("16UC1", 2);
  image.is_bigendian = 1;
  expectInputError([&] { fromMessage(image); }, {"is_bigendian"});
  image = makeImage("mono8", 1);
  image.width = 0;
  expectInputError([&] { fromMessage(image); }, {"width"});
  image = makeImage("mono8", 1);
  image.data.resize(6);
  expectInputError([&] { fromMessage(image); }, {"'data'"});
  image.width = image.height = 0xFFFFFFFF;
  expectInputError([&] { fromMessage(image); }, {"width or height"});
}

TEST(ImageViewTest, ColourImagesAreViewedAndOthersAreNamed) {
  const sensor_msgs::Image image = makeImage("bgr8", 3);
  const ImageView view = viewOf(image);
  EXPECT_EQ(view.channels, 3);
  EXPECT_FALSE(view.is_red_first);
  EXPECT_EQ(view.row_bytes, 10U);
  EXPECT_EQ(view.data, image.data.data());
  EXPECT_TRUE(viewOf(makeImage("rgba8", 4)).is_red_first);
  EXPECT_EQ(viewOf(makeImage("mono8", 1)).channels, 1);
  expectInputError([] { viewOf(makeImage("32FC1", 4)); }, {"'encoding'", "'32FC1'"});
}

TEST(CameraConversionTest, ProjectionComesFromPOrElseFromK) {
  sensor_msgs::CameraInfo info;
  expectInputError([&] { fromMessage(info, Pose{}); }, {"'P'", "'K'"});
  info.K = {500, 0, 320, 0, 500, 240, 0, 0, 1};
  EXPECT_LT((*fromMessage(info, Pose{}).project({1.0, 0.0, 10.0}) - Eigen::Vector2d(370.0, 240.0)).norm(), 1e-12);
  info.P = {400, 0, 300, 0, 0, 400, 200, 0, 0, 0, 1, 0};
  EXPECT_LT((*fromMessage(info, Pose{}).project({1.0, 0.0, 10.0}) - Eigen::Vector2d(340.0, 200.0)).norm(), 1e-12);
  info.P[0] = std::nan("");
  expectInputError([&] { fromMessage(info, Pose{}); }, {"'P'"});
}

}  // namespace
}  // namespace semantic_mht_slam
