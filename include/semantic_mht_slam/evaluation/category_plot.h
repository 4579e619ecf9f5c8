#pragma once

#include <map>
#include <string>
#include <vector>

#include "semantic_mht_slam/evaluation/svg_plot.h"

namespace semantic_mht_slam {

/// How often each number occurred.
using Histogram = std::map<int, double>;

/// Numbers that belong together in a plot by categories: one a category, NaN where there is none.
struct BarSeries {
  std::string label;  ///< for the legend
  std::string color;  ///< SVG colour; empty: see `PlotSeries`
  std::vector<double> values;
};

/// Bars from 0, side by side in each category. Throws std::invalid_argument for a series with another number of values
/// than categories.
Plot barPlot(const std::string& title, const std::string& y_label, const std::vector<std::string>& categories,
             const std::vector<BarSeries>& bars);

/// Distributions that belong together in a plot by categories: one a category, empty where there is none.
struct ViolinSeries {
  std::string label;
  std::string color;
  std::vector<Histogram> histograms;
};

/// Violins side by side in each category: the smoothed histogram to both sides of its middle, as wide for each at the
/// most frequent number, and a line at the mean. Throws as `barPlot`.
Plot violinPlot(const std::string& title, const std::string& y_label, const std::vector<std::string>& categories,
                const std::vector<ViolinSeries>& violins);

}  // namespace semantic_mht_slam
