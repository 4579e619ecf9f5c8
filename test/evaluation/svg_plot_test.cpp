#include "semantic_mht_slam/evaluation/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/trajectory_plot.h"

namespace semantic_mht_slam {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

/// The points of the first path of a document, pixels.
std::vector<std::pair<double, double>> pathPoints(const std::string& svg) {
  const std::size_t begin = svg.find("<path d=\"") + 9;
  std::string path = svg.substr(begin, svg.find('"', begin) - begin);
  std::replace(path.begin(), path.end(), 'M', ' ');
  std::replace(path.begin(), path.end(), 'L', ' ');
  std::vector<std::pair<double, double>> points;
  const std::vector<std::string_view> cells = splitBlanks(path);
  for (std::size_t i = 0; i + 1 < cells.size(); i += 2) {
    points.emplace_back(parseDouble(cells[i]).value(), parseDouble(cells[i + 1]).value());
  }
  return points;
}

Plot squarePlot(PlotSeries::Style style) {
  Plot plot;
  plot.x_label = "x [m]";
  plot.y_label = "y [m]";
  plot.series = {{"square", {0.0, 10.0, 10.0, 0.0}, {0.0, 0.0, 10.0, 10.0}, "", style}};
  return plot;
}

TEST(SvgPlotTest, EqualAspectKeepsASquareSquare) {
  Plot plot = squarePlot(PlotSeries::Style::kLine);
  plot.equal_aspect = true;
  const auto points = pathPoints(svgPlot(plot));
  ASSERT_EQ(points.size(), 4U);
  EXPECT_NEAR(points[1].first - points[0].first, points[1].second - points[2].second, 0.05);
  plot.equal_aspect = false;
  const auto stretched = pathPoints(svgPlot(plot));
  EXPECT_GT(stretched[1].first - stretched[0].first, 1.1 * (stretched[1].second - stretched[2].second));
}

TEST(SvgPlotTest, YGrowsUpwards) {
  const auto points = pathPoints(svgPlot(squarePlot(PlotSeries::Style::kLine)));
  EXPECT_LT(points[2].second, points[1].second);
}

TEST(SvgPlotTest, HasLabelsTicksAndLegend) {
  const std::string svg = svgPlot(squarePlot(PlotSeries::Style::kLine));
  EXPECT_EQ(count(svg, ">x [m]<"), 1U);
  EXPECT_EQ(count(svg, ">y [m]<"), 1U);
  EXPECT_EQ(count(svg, ">square<"), 1U);
  EXPECT_EQ(count(svg, ">10<"), 2U);  // a tick of either axis
}

TEST(SvgPlotTest, DotsAreCircles) {
  EXPECT_EQ(count(svgPlot(squarePlot(PlotSeries::Style::kDots)), "<circle"), 5U);  // and one in the legend
}

TEST(SvgPlotTest, PointsThatAreNotFiniteInterruptTheLine) {
  Plot plot;
  plot.series = {{"", {0.0, 1.0, 2.0, 3.0, 4.0}, {0.0, 1.0, std::nan(""), 1.0, 0.0}, "", PlotSeries::Style::kLine}};
  const std::string svg = svgPlot(plot);
  const std::size_t begin = svg.find("<path d=\"");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(count(svg.substr(begin), "M"), 2U);
  EXPECT_EQ(count(svg, "nan"), 0U);
}

TEST(SvgPlotTest, LongLinesAreThinnedToWhatCanBeSeen) {
  PlotSeries series;
  for (int i = 0; i < 300000; ++i) {
    series.x.push_back(i);
    series.y.push_back(std::sin(1e-4 * i));
  }
  Plot plot;
  plot.series = {series};
  const auto points = pathPoints(svgPlot(plot));
  EXPECT_LT(points.size(), 10000U);
  EXPECT_GT(points.size(), 500U);
}

TEST(SvgPlotTest, EscapesTextsAndKeepsTheEndOfLongLabels) {
  Plot plot = squarePlot(PlotSeries::Style::kLine);
  plot.title = "a < b & \"c\"";
  plot.series[0].label = "a_very_long_folder_name/of_a_run/trajectory";
  const std::string svg = svgPlot(plot);
  EXPECT_EQ(count(svg, "a &lt; b &amp; &quot;c&quot;"), 1U);
  EXPECT_EQ(count(svg, "of_a_run/trajectory<"), 1U);
  EXPECT_EQ(count(svg, "a_very_long"), 0U);
}

TEST(SvgPlotTest, PlotsOfNothingOrOnePointAreDocuments) {
  Plot plot;
  EXPECT_EQ(count(svgPlot(plot), "</svg>"), 1U);
  for (const double value : {0.0, 1e-300, 5e8, -1e15}) {
    plot.series = {{"one", {value}, {value}, "", PlotSeries::Style::kDots}};
    const std::string svg = svgPlot(plot);
    EXPECT_EQ(count(svg, "<circle"), 2U);
    EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0U);
    EXPECT_LT(svg.size(), 20000U);
  }
}

TEST(SvgPlotTest, SamePlotSameText) {
  EXPECT_EQ(svgPlot(squarePlot(PlotSeries::Style::kLine)), svgPlot(squarePlot(PlotSeries::Style::kLine)));
}

TEST(SvgPlotTest, RefusesMoreOfOneCoordinate) {
  Plot plot;
  plot.series = {{"", {0.0, 1.0}, {0.0}, "", PlotSeries::Style::kLine}};
  EXPECT_THROW(svgPlot(plot), std::invalid_argument);
}

TEST(TrajectoryPlotTest, DrawsTheGroundPlaneOfTheCamera) {
  const std::vector<NamedPath> paths = {{"truth", {{1.0, 2.0, 3.0}}}, {"odometry", {{4.0, 5.0, 6.0}}}};
  const Plot plot = trajectoryPlot(paths);
  EXPECT_EQ(plot.series[0].y[0], 3.0);
  EXPECT_EQ(plot.series[1].x[0], 4.0);
  EXPECT_EQ(plot.series[1].style, PlotSeries::Style::kDashed);
  EXPECT_TRUE(plot.equal_aspect);
}

TEST(TrajectoryPlotTest, ErrorsGoOverFramesFromZero) {
  const Plot plot = errorPlot("title", "RMSE [m]", {{"run", {0.0, 1.0, 3.0}, {5.0, 6.0, 7.0}}});
  EXPECT_EQ(plot.series[0].x, (std::vector<double>{0.0, 1.0, 3.0}));
  EXPECT_TRUE(plot.y_from_zero);
  EXPECT_EQ(plot.y_label, "RMSE [m]");
}

}  // namespace
}  // namespace semantic_mht_slam
