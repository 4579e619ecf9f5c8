#include "semantic_mht_slam/evaluation/violin_plot.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(ViolinPlotTest, IsWidestAtTheMostFrequentValueAndSymmetric) {
  const Violin violin{"dpmhm", {{1.0, 100.0}, {2.0, 30.0}, {5.0, 10.0}}};
  const Plot plot = violinPlot("Hypotheses", "hypotheses", {violin});
  ASSERT_EQ(plot.series.size(), 2U);  // outline and mean
  const PlotSeries& outline = plot.series[0];
  const auto widest = std::max_element(outline.x.begin(), outline.x.end());
  EXPECT_NEAR(outline.y[static_cast<std::size_t>(widest - outline.x.begin())], 1.0, 0.1);
  const double left = 1.0 - *std::min_element(outline.x.begin(), outline.x.end());
  EXPECT_NEAR(left, *widest - 1.0, 1e-12);
  EXPECT_NEAR(plot.series[1].y[0], (100.0 + 60.0 + 50.0) / 140.0, 1e-12);
}

TEST(ViolinPlotTest, EmptyViolinsAreLeftOut) {
  EXPECT_TRUE(std::isnan(meanOf({"none", {}})));
  EXPECT_TRUE(violinPlot("", "", {{"none", {}}}).series.empty());
}

}  // namespace
}  // namespace semantic_mht_slam
