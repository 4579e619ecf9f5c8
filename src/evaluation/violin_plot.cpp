#include "semantic_mht_slam/evaluation/violin_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

constexpr double kSmoothing = 0.5;  // in units of the values
constexpr double kTail = 1.0;       // the outline ends so far beyond the outermost values
constexpr double kHalfWidth = 0.4;  // of the place of a violin
constexpr int kSteps = 200;

double density(const Violin& violin, double value) {
  double sum = 0.0;
  for (const auto& [center, count] : violin.counts) {
    const double d = (value - center) / kSmoothing;
    sum += count * std::exp(-0.5 * d * d);
  }
  return sum;
}

PlotSeries outline(const Violin& violin, double place) {
  const double low = violin.counts.front().first - kTail;
  const double high = violin.counts.back().first + kTail;
  std::vector<std::pair<double, double>> widths;  // value, density
  double largest = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double value = low + (high - low) * i / kSteps;
    widths.emplace_back(value, density(violin, value));
    largest = std::max(largest, widths.back().second);
  }
  PlotSeries series;
  const auto add = [&](double value, double width) {
    series.x.push_back(place + width);
    series.y.push_back(value);
  };
  for (const auto& [value, width] : widths) add(value, -kHalfWidth * width / largest);
  for (auto it = widths.rbegin(); it != widths.rend(); ++it) add(it->first, kHalfWidth * it->second / largest);
  add(widths.front().first, -kHalfWidth * widths.front().second / largest);
  series.label = violin.label + ", mean " + formatFixed(meanOf(violin), 2);
  return series;
}

}  // namespace

double meanOf(const Violin& violin) {
  double sum = 0.0;
  double total = 0.0;
  for (const auto& [value, count] : violin.counts) {
    sum += value * count;
    total += count;
  }
  return total > 0.0 ? sum / total : std::numeric_limits<double>::quiet_NaN();
}

Plot violinPlot(const std::string& title, const std::string& y_label, const std::vector<Violin>& violins) {
  Plot plot;
  plot.title = title;
  plot.y_label = y_label;
  plot.x_label = "run";
  plot.y_from_zero = true;
  double place = 1.0;
  for (const Violin& violin : violins) {
    if (violin.counts.empty()) continue;
    plot.series.push_back(outline(violin, place));
    PlotSeries mean;
    mean.color = "#333333";
    mean.x = {place - kHalfWidth, place + kHalfWidth};
    mean.y = {meanOf(violin), meanOf(violin)};
    plot.series.push_back(mean);
    place += 1.0;
  }
  return plot;
}

}  // namespace semantic_mht_slam
