#include <limits>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/NavSatFix.h>

#include <semantic_mht_slam/SaveResults.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/driving_node.h"
#include "support/spinner.h"
#include "support/square_fixes.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const testing::Environment* const kSpinner = testing::AddGlobalTestEnvironment(new Spinner);

sensor_msgs::NavSatFix toMessage(const GnssFix& fix) {
  sensor_msgs::NavSatFix message;
  message.header.stamp = toRosTime(fix.stamp);
  message.header.frame_id = "gps";  // of which tf knows nothing
  message.latitude = fix.place.latitude_deg;
  message.longitude = fix.place.longitude_deg;
  message.altitude = fix.place.altitude_m;
  Eigen::Map<Eigen::Matrix3d>(message.position_covariance.data()) = *fix.cov_m2;
  message.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;
  return message;
}

/// How the node writes its landmarks when nobody says where the map is.
std::string geoJsonOf(DrivingNode& driving, const std::string& folder) {
  SaveResults::Request request;
  request.path = folder;
  const SaveResults::Response saved = driving.call<SaveResults>("save_results", request);
  EXPECT_TRUE(saved.success) << saved.message;
  return readFile(folder + "/landmarks.geojson");
}

TEST(GnssNodeTest, FixesGiveTheMapItsPlaceWhichOutlivesTheNode) {
  const TemporaryFolder folder;
  const SquareDrive drive(1);
  {
    DrivingNode driving("mapping");
    ros::Publisher fixes = driving.node.handle().advertise<sensor_msgs::NavSatFix>("fix", 1000);
    ASSERT_TRUE(driving.isReady());
    ASSERT_TRUE(waitFor([&] { return fixes.getNumSubscribers() > 0; }));
    EXPECT_EQ(driving.node.value("estimator", "fixes received"), "");
    sensor_msgs::NavSatFix bad = toMessage(squareFixAt(drive, 0));
    bad.latitude = std::numeric_limits<double>::quiet_NaN();
    fixes.publish(bad);
    bad = toMessage(squareFixAt(drive, 1));
    bad.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
    fixes.publish(bad);
    bad = toMessage(squareFixAt(drive, 2));
    bad.header.stamp = ros::Time();
    fixes.publish(bad);
    for (int i = 0; i < 300; i += 10) {
      fixes.publish(toMessage(squareFixAt(drive, i)));
      ASSERT_TRUE(driving.feed(i, i + 10));
    }
    ASSERT_TRUE(driving.call<std_srvs::Trigger>("finish_submap").success);
    EXPECT_TRUE(driving.node.comesToSay("estimator", "fixes received", "32"));  // one had no stamp
    EXPECT_TRUE(driving.node.comesToSay("estimator", "map has its place on the Earth", "yes"));
    EXPECT_NE(geoJsonOf(driving, folder / "mapped").find("WGS 84"), std::string::npos);
    ASSERT_TRUE(driving.save(folder / "map.bag").success);
  }
  DrivingNode again("again");
  ASSERT_TRUE(again.isReady());
  EXPECT_EQ(geoJsonOf(again, folder / "empty").find("WGS 84"), std::string::npos);
  ASSERT_TRUE(again.load(folder / "map.bag").success);
  EXPECT_EQ(geoJsonOf(again, folder / "loaded"), readFile(folder / "mapped/landmarks.geojson"));
}

}  // namespace
}  // namespace semantic_mht_slam
