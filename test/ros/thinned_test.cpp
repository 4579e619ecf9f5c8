#include "semantic_mht_slam/ros/thinned.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

std::vector<int> upTo(int count) {
  std::vector<int> values(static_cast<std::size_t>(count));
  std::iota(values.begin(), values.end(), 0);
  return values;
}

TEST(ThinnedTest, NoMoreThanAskedForWithTheFirstAndTheLast) {
  for (int most = 2; most <= 9; ++most) {
    for (int count = 0; count <= 200; ++count) {
      const std::vector<int> kept = thinned(upTo(count), static_cast<std::size_t>(most));
      ASSERT_LE(kept.size(), static_cast<std::size_t>(most)) << count;
      if (count <= most) {
        ASSERT_EQ(kept, upTo(count));
        continue;
      }
      ASSERT_EQ(kept.front(), 0);
      ASSERT_EQ(kept.back(), count - 1);
      ASSERT_GE(kept.size(), static_cast<std::size_t>(most) / 2) << "no fewer than need be";
    }
  }
}

TEST(ThinnedTest, WhatIsLeftOutStaysOut) {
  for (int count = 11; count <= 300; ++count) {
    const std::vector<int> before = thinned(upTo(count), 10);
    const std::vector<int> after = thinned(upTo(count + 1), 10);
    for (std::size_t i = 0; i + 1 < after.size(); ++i) {
      const int value = after[i];
      EXPECT_TRUE(value == count - 1 || std::count(before.begin(), before.end(), value) == 1) << count << ": " << value;
    }
  }
}

}  // namespace
}  // namespace semantic_mht_slam
