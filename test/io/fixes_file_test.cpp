#include "semantic_mht_slam/io/fixes_file.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

class FixesFileTest : public ::testing::Test {
 protected:
  FixesFile read(const std::string& content) const {
    writeFileAtomically(path_, content);
    return readFixes(path_);
  }

  void expectRefused(const std::string& content, const std::vector<std::string>& parts) const {
    expectInputError([&] { read(content); }, parts);
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "fixes.csv";
};

TEST_F(FixesFileTest, ColumnsInAnyOrderAndRowsInTheOrderOfTheirStamps) {
  const FixesFile file = read(
      "longitude,time,latitude,stddev_up,altitude,stddev_north,stddev_east,satellites\n"
      "8.5,2.5,47.25,4,400.5,3,2,9\n"
      "8.25,1,47.125,,,,,\n"
      "8.125,3,47,,,2,1,\n");
  EXPECT_NE(file.notice.find("satellites"), std::string::npos) << file.notice;
  ASSERT_EQ(file.fixes.size(), 3U);
  EXPECT_EQ(file.fixes[0].stamp, stampFromSeconds(1.0));
  EXPECT_TRUE(file.fixes[0].has_fix);
  EXPECT_TRUE(std::isnan(file.fixes[0].place.altitude_m));
  EXPECT_FALSE(file.fixes[0].cov_m2);
  EXPECT_FALSE(file.fixes[0].antenna_m);
  EXPECT_EQ(file.fixes[1].place.latitude_deg, 47.25);
  EXPECT_EQ(file.fixes[1].place.longitude_deg, 8.5);
  EXPECT_EQ(file.fixes[1].place.altitude_m, 400.5);
  ASSERT_TRUE(file.fixes[1].cov_m2 && file.fixes[2].cov_m2);
  EXPECT_EQ(*file.fixes[1].cov_m2, Eigen::Matrix3d(Eigen::Vector3d(4.0, 9.0, 16.0).asDiagonal()));
  EXPECT_EQ((*file.fixes[2].cov_m2)(2, 2), 16.0) << "twice the larger horizontal deviation";
}

TEST_F(FixesFileTest, NumbersThatTheEstimatorCountsStay) {
  const FixesFile file = read("time,latitude,longitude\n-1,nan,200\n");
  ASSERT_EQ(file.fixes.size(), 1U);
  EXPECT_LT(file.fixes[0].stamp, 0);
  EXPECT_TRUE(std::isnan(file.fixes[0].place.latitude_deg));
}

TEST_F(FixesFileTest, ErrorsNameFileLineAndColumn) {
  expectRefused("time,latitude\n1,2\n", {path_, "longitude"});
  expectRefused("time,latitude,longitude\n1,47,8\nx,47,8\n", {path_ + ":3", "'time'"});
  expectRefused("time,latitude,longitude\n1e300,47,8\n", {path_ + ":2", "'time'", "no time"});
  expectRefused("time,latitude,longitude\n9.5e9,47,8\n", {path_ + ":2", "'time'", "no time"});
  expectRefused("time,latitude,longitude\n1,47\n", {path_ + ":2"});
  expectRefused("time,latitude,longitude\n1,47,\n", {path_ + ":2", "'longitude'"});
  const std::string header = "time,latitude,longitude,stddev_east,stddev_north,stddev_up\n";
  expectRefused(header + "1,47,8,1,,\n", {path_ + ":2", "'stddev_north'", "empty"});
  expectRefused(header + "1,47,8,,,3\n", {path_ + ":2", "'stddev_east'", "empty"});
  expectRefused(header + "1,47,8,0,1,\n", {path_ + ":2", "'stddev_east'", "positive"});
  expectRefused(header + "1,47,8,1,-1,\n", {path_ + ":2", "'stddev_north'", "positive"});
  expectInputError([&] { readFixes(folder_ / "none.csv"); }, {"none.csv"});
}

}  // namespace
}  // namespace semantic_mht_slam
