#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/gnss_fixes.h"
#include "semantic_mht_slam/slam/slam.h"

#include "support/square_fixes.h"

namespace semantic_mht_slam {
namespace {

constexpr double kNoAltitude = std::numeric_limits<double>::quiet_NaN();
constexpr int kOriginDrive = 300;  // less than a round: no loop closure helps

class GnssOriginTest : public testing::Test {
 protected:
  /// Every fifth frame has a fix, as `change` makes it of the right one.
  template <class Change>
  void drive(const Change& change) {
    for (int i = 0; i < kOriginDrive; ++i) {
      GnssFix fix = squareFixAt(drive_, i);
      change(i, fix);
      if (i % 5 == 0) slam_.addFix(fix);
      drive_.feed(slam_, i, i + 1);
    }
  }

  /// Where the map says that the drive began.
  Eigen::Vector3d begin_m() const {
    const std::optional<GeoReference> reference = geoReferenceOf(slam_);
    EXPECT_TRUE(reference);
    if (!reference) return Eigen::Vector3d::Constant(kNoAltitude);
    const Eigen::Vector3d first_m = trajectoryOf(slam_).front().T_world_base.translation_m;
    return toEastNorthUp(kSquareOrigin, toGeodetic(reference->origin, reference->T_enu_map * first_m));
  }

  const SlamConfig config_ = defaultsOf(Method::kDpmhm);
  const ClassTable classes_ = makeStreetClasses();
  const SquareDrive drive_{7};
  Slam slam_{config_, classes_};
};

TEST_F(GnssOriginTest, AStalePlaceOfTheFirstKeyframesGivesWayToARowOfOthers) {
  drive([](int i, GnssFix& fix) {
    if (i <= 25) fix.place = {-33.9, 151.2, 20.0};
  });
  slam_.finish();
  EXPECT_EQ(slam_.parts().fixes.counters().far_away, 5U) << "the sixth in a row moves the origin";
  ASSERT_TRUE(geoReferenceOf(slam_));
  EXPECT_NEAR(geoReferenceOf(slam_)->origin.latitude_deg, kSquareOrigin.latitude_deg, 0.01);
  EXPECT_LT((begin_m() - squareInEnu() * drive_.truthAt(0).translation_m).head<2>().norm(), 2.0);
}

TEST_F(GnssOriginTest, ARowOfFixesFarAwayMovesNoOriginThatManyPositionsHave) {
  drive([](int i, GnssFix& fix) {
    if (i >= 150) fix.place = {-33.9, 151.2, 20.0};
  });
  slam_.finish();
  ASSERT_TRUE(geoReferenceOf(slam_));
  EXPECT_NEAR(geoReferenceOf(slam_)->origin.latitude_deg, kSquareOrigin.latitude_deg, 0.01);
  EXPECT_GE(slam_.parts().fixes.counters().far_away, 6U);
}

TEST_F(GnssOriginTest, TheFirstKnownAltitudeIsThatOfAnOriginWithoutOne) {
  drive([](int i, GnssFix& fix) {
    if (i < 30 || i % 10 == 5) fix.place.altitude_m = kNoAltitude;
  });
  slam_.finish();
  ASSERT_TRUE(geoReferenceOf(slam_));
  EXPECT_NEAR(geoReferenceOf(slam_)->origin.altitude_m, kSquareOrigin.altitude_m, 5.0);
  EXPECT_LT(std::abs(begin_m().z()), 5.0);
}

TEST_F(GnssOriginTest, AFixThatIsTooCoarseIsDroppedAndOnlyUpwardsLosesItsAltitude) {
  GnssFix fix = squareFixAt(drive_, 0);
  (*fix.cov_m2)(0, 0) = 1e9;
  slam_.addFix(fix);
  fix = squareFixAt(drive_, 1);
  (*fix.cov_m2)(1, 1) = std::numeric_limits<double>::infinity();  // the square of 1e200
  slam_.addFix(fix);
  EXPECT_EQ(slam_.parts().fixes.counters().too_coarse, 2U);
  drive([](int, GnssFix& each) {
    each.place.altitude_m = 9000.0;
    (*each.cov_m2)(2, 2) = std::numeric_limits<double>::infinity();
  });
  slam_.finish();
  EXPECT_EQ(slam_.parts().fixes.counters().too_coarse, 2U);
  EXPECT_EQ(slam_.parts().fixes.counters().covariances_unknown, 0U);
  EXPECT_GT(slam_.parts().fixes.counters().used, 20U);
  ASSERT_TRUE(geoReferenceOf(slam_));
  EXPECT_EQ(geoReferenceOf(slam_)->origin.altitude_m, 0.0);
}

TEST_F(GnssOriginTest, LocalizingTakesNoFixAndLeavesTheStateAlone) {
  drive([](int, GnssFix&) {});
  slam_.finish();
  slam_.localize();
  const SlamState before = slam_.snapshot();
  GnssFix fix = squareFixAt(drive_, kOriginDrive);
  EXPECT_FALSE(slam_.addFix(fix));
  const SlamState after = slam_.snapshot();
  ASSERT_EQ(before.sections.size(), after.sections.size());
  for (std::size_t i = 0; i < before.sections.size(); ++i) {
    EXPECT_TRUE(before.sections[i].bytes == after.sections[i].bytes) << before.sections[i].name;
  }
  slam_.resumeMapping();
  EXPECT_TRUE(slam_.addFix(fix));
}

}  // namespace
}  // namespace semantic_mht_slam
