#include "semantic_mht_slam/common/length.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/config.h"

namespace semantic_mht_slam {
namespace {

struct Lengths {
  Length way_m{30.0};
  Length area_m2{100.0, 2};
};

void describe(Lengths& lengths, Fields& fields) {
  fields.add("way", lengths.way_m, "m", {1.0, 100.0}, "A way.");
  fields.add("area", lengths.area_m2, "m^2", {1.0, 1e4}, "An area.");
}

class LengthTest : public ::testing::Test {
 protected:
  LengthTest() { describe(lengths_, fields_); }

  void set(const std::string& value) { applySettings({{"way", value, "test"}}, fields_); }

  Lengths lengths_;
  Fields fields_;
};

TEST_F(LengthTest, WhatIsNotSetFollowsTheSensor) {
  scaleLengths(0.5, fields_);
  EXPECT_EQ(lengths_.way_m, 15.0);
  EXPECT_EQ(lengths_.area_m2, 25.0);
}

TEST_F(LengthTest, ANumberOverrides) {
  set("7");
  scaleLengths(0.5, fields_);
  EXPECT_EQ(lengths_.way_m, 7.0);
  EXPECT_EQ(fields_.all()[0].get(), "7");
}

TEST_F(LengthTest, AutoGoesBack) {
  set("7");
  EXPECT_FALSE(lengths_.way_m.isAuto());
  set("auto");
  EXPECT_TRUE(lengths_.way_m.isAuto());
  EXPECT_EQ(lengths_.way_m, 30.0);
  EXPECT_EQ(fields_.all()[0].get(), "auto");
}

TEST_F(LengthTest, OtherTextsAndNumbersOutOfRangeAreRefused) {
  EXPECT_THROW(set("long"), std::exception);
  EXPECT_THROW(set("0.5"), std::exception);
  EXPECT_EQ(lengths_.way_m, 30.0);
}

}  // namespace
}  // namespace semantic_mht_slam
