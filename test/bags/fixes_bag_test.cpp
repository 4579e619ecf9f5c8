// Positions by satellites in bags and in map files.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/NavSatFix.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include "semantic_mht_slam/app/landmark_files.h"
#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/map_file.h"

#include "support/expect_input_error.h"
#include "support/square_fixes.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

class FixesBagTest : public ::testing::Test {
 protected:
  static sensor_msgs::NavSatFix messageOf(const GnssFix& fix, const std::string& frame) {
    sensor_msgs::NavSatFix message;
    message.header.stamp = toRosTime(fix.stamp);
    message.header.frame_id = frame;
    message.latitude = fix.place.latitude_deg;
    message.longitude = fix.place.longitude_deg;
    message.altitude = fix.place.altitude_m;
    return message;
  }

  void addInput(rosbag::Bag& bag, int frames) const {
    for (int i = 0; i < frames; ++i) {
      const Stamp stamp = SquareDrive::stampAt(i);
      bag.write("/odometry", toRosTime(stamp), toOdometry({stamp, SquareDrive::odometryAt(i)}, "odom", "base_link"));
      bag.write("/objects", toRosTime(stamp), toMessage(stamp, "base_link", drive_.detectionsAt(i), classes_));
    }
  }

  Recording read() const { return readBag(path_, classes_, {}, layout_); }

  const ClassTable classes_ = makeStreetClasses();
  const SquareDrive drive_{7};
  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "drive.bag";
  BagLayout layout_;
};

TEST_F(FixesBagTest, FixesComeWithTheAntennaThatTfKnows) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    tf2_msgs::TFMessage antenna;
    const Pose T_base_antenna{Eigen::Quaterniond::Identity(), {-0.5, 0.25, 1.5}};
    antenna.transforms.push_back(toTransform({SquareDrive::stampAt(0), T_base_antenna}, "base_link", "gps"));
    bag.write("/tf_static", toRosTime(SquareDrive::stampAt(0)), antenna);
    addInput(bag, 5);
    sensor_msgs::NavSatFix fix = messageOf(squareFixAt(drive_, 3), "gps");
    fix.position_covariance = {4.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 16.0};
    fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_DIAGONAL_KNOWN;
    bag.write("/fix", toRosTime(SquareDrive::stampAt(4)), fix);
    bag.write("/fix", toRosTime(SquareDrive::stampAt(4)), messageOf(squareFixAt(drive_, 2), "unknown"));
    fix = messageOf(squareFixAt(drive_, 4), "base_link");
    fix.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
    bag.write("/fix", toRosTime(SquareDrive::stampAt(4)), fix);
    fix.header.stamp = ros::Time();
    bag.write("/fix", toRosTime(SquareDrive::stampAt(4)), fix);
  }
  const Recording recording = read();
  ASSERT_EQ(recording.fixes.size(), 3U);
  EXPECT_EQ(recording.fixes[0].stamp, SquareDrive::stampAt(2)) << "by their stamps";
  EXPECT_FALSE(recording.fixes[0].antenna_m);
  EXPECT_FALSE(recording.fixes[0].cov_m2);
  ASSERT_TRUE(recording.fixes[1].antenna_m && recording.fixes[1].cov_m2);
  EXPECT_EQ(*recording.fixes[1].antenna_m, Eigen::Vector3d(-0.5, 0.25, 1.5));
  EXPECT_EQ((*recording.fixes[1].cov_m2)(1, 1), 9.0);
  EXPECT_FALSE(recording.fixes[2].has_fix);
  EXPECT_EQ(recording.refused.fixes_bad_stamps, 1U);
  EXPECT_EQ(recording.refused.fixes_without_transform, 1U);
  const std::vector<std::string> lines = droppedFixes({}, recording.refused, recording.names);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].rfind("/fix: 1 fixes dropped", 0), 0U) << lines[0];
  EXPECT_NE(lines[1].find("'unknown' to 'base_link'"), std::string::npos) << lines[1];
}

TEST_F(FixesBagTest, ATopicThatSomebodyAskedForMustBeThereAndOthersAreLeftAlone) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    addInput(bag, 5);
    bag.write("/fix", toRosTime(SquareDrive::stampAt(4)), std_msgs::String());
    bag.write("/gps/fix", toRosTime(SquareDrive::stampAt(4)), messageOf(squareFixAt(drive_, 2), ""));
  }
  EXPECT_TRUE(read().fixes.empty());
  layout_.fixes_topic = "gps/fix";
  EXPECT_EQ(read().fixes.size(), 1U);
  layout_.fixes_topic = "/fix";
  expectInputError([&] { read(); }, {path_, "/fix", "std_msgs/String", "sensor_msgs/NavSatFix"});
  layout_.fixes_topic = "/nowhere";
  expectInputError([&] { read(); }, {path_, "/nowhere", "/gps/fix (sensor_msgs/NavSatFix)"});
}

TEST_F(FixesBagTest, ThePlaceOfTheMapIsInItsFileAndOnlyThere) {
  const SystemConfig config;
  Slam slam(config.slam, classes_);
  feedWithFixes(slam, drive_, 0, 300);
  slam.finish();
  const std::string path = folder_ / "map.bag";
  writeMapFile(path, mapOf(slam), config, classes_);
  LoadedMap loaded = readMapFile(path, config, classes_, [] { return true; });
  EXPECT_TRUE(loaded.has_same_parameters);
  const Slam again(config.slam, classes_, std::move(loaded.state));
  ASSERT_TRUE(geoReferenceOf(slam) && geoReferenceOf(again));
  const MapOrigin origin = originOf(*geoReferenceOf(again));
  EXPECT_EQ(origin.latitude_deg, originOf(*geoReferenceOf(slam)).latitude_deg);
  EXPECT_NEAR(origin.latitude_deg, kSquareOrigin.latitude_deg, 2e-5);
  EXPECT_NEAR(origin.heading_rad, kSquareYaw_rad, 0.05);
  SystemConfig other = config;
  other.slam.gnss.cov_scale = 9.0;
  EXPECT_FALSE(readMapFile(path, other, classes_, [] { return true; }).has_same_parameters);
  Slam without(config.slam, classes_);
  drive_.feed(without, 0, 300);
  writeMapFile(path, mapOf(without), config, classes_);
  EXPECT_TRUE(readMapFile(path, other, classes_, [] { return true; }).has_same_parameters);
}

}  // namespace
}  // namespace semantic_mht_slam
