#include "semantic_mht_slam/evaluation/category_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

/// Extent of the finite numbers.
Extent extentOf(const std::vector<double>& values) {
  Extent extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    extent.low = std::min(extent.low, value);
    extent.high = std::max(extent.high, value);
  }
  return extent;
}

TEST(CategoryPlotTest, BarsReachFromZeroToTheirValueAndDoNotOverlap) {
  const Plot plot = barPlot("", "%", {"00"}, {{"a", "", {30.0}}, {"b", "", {-10.0}}});
  ASSERT_EQ(plot.series.size(), 2U);
  EXPECT_EQ(extentOf(plot.series[0].y).high, 30.0);
  EXPECT_EQ(extentOf(plot.series[0].y).low, 0.0);
  EXPECT_EQ(extentOf(plot.series[1].y).low, -10.0);
  EXPECT_LT(extentOf(plot.series[0].x).high, extentOf(plot.series[1].x).low);
}

TEST(CategoryPlotTest, AMissingValueHasNoBarAndKeepsThePlacesOfTheOthers) {
  const Plot both = barPlot("", "%", {"00", "05"}, {{"a", "", {1.0, 2.0}}});
  const Plot one = barPlot("", "%", {"00", "05"}, {{"a", "", {std::nan(""), 2.0}}});
  EXPECT_EQ(extentOf(one.series[0].x).high, extentOf(both.series[0].x).high);
  EXPECT_GT(extentOf(one.series[0].x).low, 0.5);
  EXPECT_EQ(one.x_names.size(), 2U);
}

TEST(CategoryPlotTest, AViolinIsWidestAtTheMostFrequentNumberAndSymmetric) {
  const Plot plot = violinPlot("", "", {"00"}, {{"a", "", {{{1, 10.0}, {2, 90.0}, {8, 5.0}}}}});
  const PlotSeries& outline = plot.series.front();
  const auto widest = std::max_element(
      outline.x.begin(), std::find_if(outline.x.begin(), outline.x.end(), [](double x) { return std::isnan(x); }));
  EXPECT_NEAR(outline.y[static_cast<std::size_t>(widest - outline.x.begin())], 2.0, 0.15);
  EXPECT_NEAR(extentOf(outline.x).high, -extentOf(outline.x).low, 1e-12);
  EXPECT_LT(extentOf(outline.y).low, 1.0);
  EXPECT_GT(extentOf(outline.y).high, 8.0);
}

TEST(CategoryPlotTest, TheLineInAViolinStandsAtTheMean) {
  const Plot plot = violinPlot("", "", {"00"}, {{"a", "", {{{2, 30.0}, {6, 10.0}}}}});
  EXPECT_EQ(extentOf(plot.series.back().y).low, 3.0);
  EXPECT_EQ(extentOf(plot.series.back().y).high, 3.0);
}

TEST(CategoryPlotTest, ASeriesWithAnotherNumberOfValuesThanCategoriesIsRefused) {
  EXPECT_THROW(barPlot("", "", {"00", "05"}, {{"a", "", {1.0}}}), std::invalid_argument);
  EXPECT_THROW(violinPlot("", "", {"00", "05"}, {{"a", "", {Histogram{}}}}), std::invalid_argument);
}

TEST(CategoryPlotTest, NamesOfCategoriesStandInPlaceOfNumbersAndShapesAreClosed) {
  const std::string svg = svgPlot(barPlot("", "%", {"first & only"}, {{"a", "", {30.0}}}));
  EXPECT_NE(svg.find(">first &amp; only<"), std::string::npos);
  EXPECT_NE(svg.find("Z\""), std::string::npos);
}

}  // namespace
}  // namespace semantic_mht_slam
