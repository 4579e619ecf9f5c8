#include "semantic_mht_slam/slam/gnss_fixes.h"

#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/ros_time.h"
#include "semantic_mht_slam/slam/slam.h"

#include "support/expect_input_error.h"
#include "support/square_fixes.h"
#include "support/state_mutation.h"

namespace semantic_mht_slam {
namespace {

constexpr int kLength = 300;  // less than a round: no loop closure helps

class GnssFixesTest : public testing::Test {
 protected:
  static bool hasFixSection(const SlamState& state) { return state.sections.back().name == kFixesSection; }

  static void expectSame(const Slam& a, const Slam& b) {
    const SlamState state_a = a.snapshot();
    const SlamState state_b = b.snapshot();
    ASSERT_EQ(state_a.sections.size(), state_b.sections.size());
    for (std::size_t i = 0; i < state_a.sections.size(); ++i) {
      EXPECT_TRUE(state_a.sections[i].bytes == state_b.sections[i].bytes) << state_a.sections[i].name;
    }
  }

  const SlamConfig config_ = defaultsOf(Method::kDpmhm);
  const ClassTable classes_ = makeStreetClasses();
  const SquareDrive drive_{7};
};

TEST_F(GnssFixesTest, FixesSayWhereTheMapIsOnTheEarth) {
  Slam slam(config_, classes_);
  feedWithFixes(slam, drive_, 0, kLength);
  slam.finish();
  const std::optional<GeoReference> reference = geoReferenceOf(slam);
  ASSERT_TRUE(reference);
  for (const int i : {0, 100, 250}) {
    const Eigen::Vector3d truth_m = squareInEnu() * drive_.truthAt(i).translation_m;
    const GeodeticPoint place =
        toGeodetic(reference->origin,
                   reference->T_enu_map * trajectoryOf(slam)[static_cast<std::size_t>(i)].T_world_base.translation_m);
    EXPECT_LT((toEastNorthUp(kSquareOrigin, place) - truth_m).head<2>().norm(), 1.0) << i;
  }
  EXPECT_GT(slam.parts().fixes.counters().used, 20U);
  EXPECT_LT((trajectoryOf(slam).front().T_world_base.translation_m - SquareDrive::odometryAt(0).translation_m).norm(),
            1e-9);
}

TEST_F(GnssFixesTest, TheAntennaIsWhereTheFixSaysElseWhereTheParametersDo) {
  const Eigen::Vector3d antenna_m(0.0, 4.0, 1.0);
  SlamConfig elsewhere = config_;
  elsewhere.gnss.antenna_y_m = antenna_m.y();
  elsewhere.gnss.antenna_z_m = antenna_m.z();
  Slam by_fix(config_, classes_);
  Slam by_parameter(elsewhere, classes_);
  for (int i = 0; i < kLength; ++i) {
    GnssFix fix = squareFixAt(drive_, i, 0.1);
    fix.place = toGeodetic(kSquareOrigin, squareInEnu() * (drive_.truthAt(i) * antenna_m));
    if (i % 5 == 0) by_parameter.addFix(fix);
    fix.antenna_m = antenna_m;
    if (i % 5 == 0) by_fix.addFix(fix);
    for (Slam* slam : {&by_fix, &by_parameter}) drive_.feed(*slam, i, i + 1);
  }
  by_fix.finish();
  by_parameter.finish();
  expectSame(by_fix, by_parameter);
  const std::optional<GeoReference> reference = geoReferenceOf(by_fix);
  ASSERT_TRUE(reference);
  const GeodeticPoint begin = toGeodetic(reference->origin, reference->T_enu_map * Eigen::Vector3d::Zero());
  EXPECT_LT(toEastNorthUp(kSquareOrigin, begin).head<2>().norm(), 0.5);
}

TEST_F(GnssFixesTest, WithoutFixesTheStateIsThatOfAProgramThatKnowsNone) {
  SlamConfig off = config_;
  off.gnss.use = false;
  Slam without(config_, classes_);
  Slam ignoring(off, classes_);
  drive_.feed(without, 0, kLength);
  feedWithFixes(ignoring, drive_, 0, kLength);
  without.finish();
  ignoring.finish();
  EXPECT_FALSE(hasFixSection(without.snapshot()));
  EXPECT_FALSE(geoReferenceOf(without));
  expectSame(without, ignoring);
}

TEST_F(GnssFixesTest, FixesThatComeLateGiveTheSameMapToTheLastBit) {
  Slam at_once(config_, classes_);
  Slam late(config_, classes_);
  feedWithFixes(at_once, drive_, 0, kLength, 5, 0);
  feedWithFixes(late, drive_, 0, kLength, 5, 8);
  for (int i = kLength - 8; i < kLength; ++i) {
    if (i % 5 == 0) late.addFix(squareFixAt(drive_, i));
  }
  at_once.finish();
  late.finish();
  ASSERT_TRUE(geoReferenceOf(late));
  expectSame(at_once, late);
}

TEST_F(GnssFixesTest, GoingOnFromASnapshotEqualsNeverHavingStopped) {
  Slam whole(config_, classes_);
  Slam first(config_, classes_);
  feedWithFixes(whole, drive_, 0, 600);
  feedWithFixes(first, drive_, 0, 333);
  ASSERT_TRUE(hasFixSection(first.snapshot()));
  Slam second(config_, classes_, first.snapshot());
  ASSERT_TRUE(geoReferenceOf(second));
  EXPECT_EQ(geoReferenceOf(second)->T_enu_map.matrix(), geoReferenceOf(first)->T_enu_map.matrix());
  EXPECT_EQ(geoReferenceOf(second)->origin.latitude_deg, geoReferenceOf(first)->origin.latitude_deg);
  feedWithFixes(second, drive_, 333, 600);
  whole.finish();
  second.finish();
  expectSame(whole, second);
}

TEST_F(GnssFixesTest, UnusableFixesAreDroppedByCauseAndChangeNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Slam slam(config_, classes_);
  Slam without(config_, classes_);
  const auto feedBad = [&](const GnssFix& fix) { slam.addFix(fix); };
  GnssFix none = squareFixAt(drive_, 10);
  none.has_fix = false;
  feedBad(none);
  GnssFix invalid = squareFixAt(drive_, 11);
  invalid.place.latitude_deg = kNan;
  feedBad(invalid);
  invalid.place = {91.0, 8.0, 0.0};
  feedBad(invalid);
  invalid.place = {47.0, 181.0, 0.0};
  feedBad(invalid);
  invalid.place = {47.0, 8.0, std::numeric_limits<double>::infinity()};
  feedBad(invalid);
  GnssFix null_island = squareFixAt(drive_, 12);
  null_island.place = {0.0, 0.0, 10.0};
  feedBad(null_island);
  GnssFix stamp = squareFixAt(drive_, 13);
  stamp.stamp = -1;
  feedBad(stamp);
  stamp.stamp = kLastStamp + 1;
  feedBad(stamp);
  GnssFix ahead = squareFixAt(drive_, 14);
  ahead.stamp = kLastStamp;
  feedBad(ahead);
  for (Slam* each : {&slam, &without}) {
    drive_.feed(*each, 0, kLength);
    each->finish();
  }
  feedBad(squareFixAt(drive_, 15));  // its keyframes are done with
  const GnssCounters& counters = slam.parts().fixes.counters();
  EXPECT_EQ(counters.received, 10U);
  EXPECT_EQ(counters.no_fix, 1U);
  EXPECT_EQ(counters.invalid, 4U);
  EXPECT_EQ(counters.null_island, 1U);
  EXPECT_EQ(counters.bad_stamps, 2U);
  EXPECT_EQ(counters.far_ahead, 1U);
  EXPECT_EQ(counters.late, 1U);
  EXPECT_EQ(counters.used, 0U);
  for (std::size_t i = 0; i < trajectoryOf(slam).size(); ++i) {
    ASSERT_EQ(trajectoryOf(slam)[i].T_world_base.matrix(), trajectoryOf(without)[i].T_world_base.matrix());
  }
}

TEST_F(GnssFixesTest, AFirstFixOnAnotherContinentIsNotTheOrigin) {
  Slam slam(config_, classes_);
  GnssFix wrong = squareFixAt(drive_, 0);
  wrong.place = {-33.9, 151.2, 20.0};
  slam.addFix(wrong);
  slam.addFix(wrong);  // of one stamp
  for (int i = 0; i < kLength; ++i) {
    if (i > 0 && i % 5 == 0) slam.addFix(squareFixAt(drive_, i));
    drive_.feed(slam, i, i + 1);
  }
  slam.finish();
  ASSERT_TRUE(geoReferenceOf(slam));
  EXPECT_NEAR(geoReferenceOf(slam)->origin.latitude_deg, kSquareOrigin.latitude_deg, 0.01);
  EXPECT_EQ(slam.parts().fixes.counters().far_away, 1U);
  EXPECT_EQ(slam.parts().fixes.counters().repeated, 1U);
}

TEST_F(GnssFixesTest, WhereNoKeyframesComeTheNewestFixesAreKept) {
  GnssFixes fixes(config_.gnss);
  const auto sizeAfter = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      GnssFix fix = squareFixAt(drive_, 0);
      fix.stamp = SquareDrive::stampAt(i);
      fixes.add(fix);
    }
    StateArchive archive;
    fixes.transfer(archive, Map(0.5));
    return archive.written().size();
  };
  const std::size_t few = sizeAfter(0, 1000);
  const std::size_t full = sizeAfter(1000, 7000);
  EXPECT_LT(sizeAfter(7000, 9000), full + 1000U);
  EXPECT_LT(full, 7U * few);
  EXPECT_EQ(fixes.counters().crowded_out, 3000U);
}

TEST_F(GnssFixesTest, WithoutCovarianceAndAltitudeTheDefaultsHold) {
  Slam slam(config_, classes_);
  for (int i = 0; i < 480; ++i) {
    GnssFix fix = squareFixAt(drive_, i);
    fix.place.altitude_m = std::numeric_limits<double>::quiet_NaN();
    fix.cov_m2.reset();
    if (i % 10 == 0) slam.addFix(fix);
    drive_.feed(slam, i, i + 1);
  }
  slam.finish();
  EXPECT_EQ(slam.parts().fixes.counters().covariances_unknown, 48U);
  ASSERT_TRUE(geoReferenceOf(slam));
  EXPECT_LT(trajectoryOf(slam).back().T_world_base.translation_m.z(), 1.0);
}

TEST_F(GnssFixesTest, ASectionThatWasChangedIsRefusedByNameOrLivedWith) {
  Slam good(config_, classes_);
  feedWithFixes(good, drive_, 0, kLength);
  const SlamState state = good.snapshot();
  ASSERT_TRUE(hasFixSection(state));
  int refused = 0;
  for (int trial = 0; trial < 150; ++trial) {
    Rng rng = Rng(5).fork("fixes", static_cast<std::uint64_t>(trial));
    SlamState changed = state;
    changed.sections.back().bytes = mutated(std::move(changed.sections.back().bytes), rng);
    try {
      Slam slam(config_, classes_, changed);
      if (trial % 7 != 0) continue;
      EXPECT_NO_THROW(feedWithFixes(slam, drive_, kLength, kLength + 25)) << trial;
      EXPECT_NO_THROW(slam.finish()) << trial;
      EXPECT_TRUE(trajectoryOf(slam).back().T_world_base.isValid()) << trial;
    } catch (const InputError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("section 'fixes'"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, 15);
}

TEST_F(GnssFixesTest, HostileValuesOfTheSectionAreRefused) {
  Slam good(config_, classes_);
  feedWithFixes(good, drive_, 0, kLength);
  const SlamState state = good.snapshot();
  const GeoReference reference = *geoReferenceOf(good);
  const auto expectRefused = [&](double from, double to, const std::string& reason) {
    SlamState changed = state;
    changed.sections.back().bytes = withNumber(state.sections.back().bytes, from, to);
    ASSERT_NE(changed.sections.back().bytes, state.sections.back().bytes);
    expectInputError([&] { Slam(config_, classes_, changed); }, {"section 'fixes'", reason});
  };
  expectRefused(reference.origin.latitude_deg, 91.0, "not on the Earth");
  expectRefused(reference.origin.latitude_deg, std::numeric_limits<double>::quiet_NaN(), "");
  expectRefused(reference.T_enu_map.translation_m.x(), 1e10, "a frame of fixes whose pose is none");
  const double variance_m2 = config_.gnss.cov_scale * (kSquareFixStddev_m * kSquareFixStddev_m +
                                                       config_.gnss.least_stddev_m * config_.gnss.least_stddev_m);
  expectRefused(variance_m2, -1.0, "covariance is not positive");
  expectRefused(variance_m2, 0.0, "covariance is not positive");
}

}  // namespace
}  // namespace semantic_mht_slam
