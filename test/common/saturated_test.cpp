#include "semantic_mht_slam/common/saturated.h"

#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(SaturatedTest, WhatFitsIsKeptAndWhatDoesNotIsCut) {
  for (const int value : {-7, 0, 1000000000}) EXPECT_EQ(saturatedInt(value), value);
  for (const double large : {2e9, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(saturatedInt(large), std::numeric_limits<int>::max() / 2);
    EXPECT_EQ(saturatedInt(-large), -(std::numeric_limits<int>::max() / 2));
  }
  EXPECT_LT(saturatedInt(std::nan("")), 0);
}

}  // namespace
}  // namespace semantic_mht_slam
