#include "semantic_mht_slam/evaluation/category_plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace semantic_mht_slam {
namespace {

constexpr double kInterruption = std::numeric_limits<double>::quiet_NaN();
constexpr double kCategoryWidth = 0.8;  // of the distance between categories
constexpr double kMemberWidth = 0.9;    // of a member's share of its category
constexpr double kKernelStddev = 0.35;  // smooths counts that differ by one into one shape
constexpr double kKernelReach = 3.0;    // standard deviations
constexpr int kSamplesPerUnit = 10;

Plot emptyPlot(const std::string& title, const std::string& y_label, const std::vector<std::string>& categories) {
  Plot plot;
  plot.title = title;
  plot.y_label = y_label;
  plot.y_from_zero = true;
  for (std::size_t i = 0; i < categories.size(); ++i) {
    plot.x_names.emplace_back(static_cast<double>(i), categories[i]);
  }
  return plot;
}

void requireOneACategory(std::size_t values, std::size_t categories) {
  if (values != categories) throw std::invalid_argument("a series with another number of values than categories");
}

/// Where a member stands: the middle of its share of the category, and half its width.
struct Place {
  double middle = 0.0;
  double half_width = 0.0;
};

Place placeOf(std::size_t category, std::size_t member, std::size_t members) {
  const double share = kCategoryWidth / static_cast<double>(members);
  const double offset = (static_cast<double>(member) + 0.5) * share - 0.5 * kCategoryWidth;
  return {static_cast<double>(category) + offset, 0.5 * kMemberWidth * share};
}

void addPoint(PlotSeries& series, double x, double y) {
  series.x.push_back(x);
  series.y.push_back(y);
}

double smoothed(const Histogram& histogram, double at) {
  double sum = 0.0;
  for (const auto& [value, count] : histogram) {
    const double distance = (at - value) / kKernelStddev;
    sum += count * std::exp(-0.5 * distance * distance);
  }
  return sum;
}

double meanOf(const Histogram& histogram) {
  double sum = 0.0;
  double total = 0.0;
  for (const auto& [value, count] : histogram) {
    sum += count * value;
    total += count;
  }
  return sum / total;
}

void addViolin(const Histogram& histogram, const Place& place, PlotSeries& outline) {
  const double low = histogram.begin()->first - kKernelReach * kKernelStddev;
  const double high = histogram.rbegin()->first + kKernelReach * kKernelStddev;
  const int samples = static_cast<int>(std::ceil((high - low) * kSamplesPerUnit));
  std::vector<std::pair<double, double>> profile;  // height, density
  double peak = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double y = low + (high - low) * i / samples;
    profile.emplace_back(y, smoothed(histogram, y));
    peak = std::max(peak, profile.back().second);
  }
  for (const auto& [y, density] : profile) addPoint(outline, place.middle + place.half_width * density / peak, y);
  std::reverse(profile.begin(), profile.end());
  for (const auto& [y, density] : profile) addPoint(outline, place.middle - place.half_width * density / peak, y);
  addPoint(outline, kInterruption, kInterruption);
}

void addMean(const Histogram& histogram, const Place& place, PlotSeries& lines) {
  const double mean = meanOf(histogram);
  addPoint(lines, place.middle - place.half_width, mean);
  addPoint(lines, place.middle + place.half_width, mean);
  addPoint(lines, kInterruption, kInterruption);
}

}  // namespace

Plot barPlot(const std::string& title, const std::string& y_label, const std::vector<std::string>& categories,
             const std::vector<BarSeries>& bars) {
  Plot plot = emptyPlot(title, y_label, categories);
  for (std::size_t member = 0; member < bars.size(); ++member) {
    requireOneACategory(bars[member].values.size(), categories.size());
    PlotSeries series{bars[member].label, {}, {}, bars[member].color, PlotSeries::Style::kFilled};
    for (std::size_t i = 0; i < categories.size(); ++i) {
      const double value = bars[member].values[i];
      if (!std::isfinite(value)) continue;
      const Place place = placeOf(i, member, bars.size());
      addPoint(series, place.middle - place.half_width, 0.0);
      addPoint(series, place.middle - place.half_width, value);
      addPoint(series, place.middle + place.half_width, value);
      addPoint(series, place.middle + place.half_width, 0.0);
      addPoint(series, kInterruption, kInterruption);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot violinPlot(const std::string& title, const std::string& y_label, const std::vector<std::string>& categories,
                const std::vector<ViolinSeries>& violins) {
  Plot plot = emptyPlot(title, y_label, categories);
  PlotSeries means{"mean", {}, {}, "#000000", PlotSeries::Style::kLine};
  for (std::size_t member = 0; member < violins.size(); ++member) {
    requireOneACategory(violins[member].histograms.size(), categories.size());
    PlotSeries outline{violins[member].label, {}, {}, violins[member].color, PlotSeries::Style::kFilled};
    for (std::size_t i = 0; i < categories.size(); ++i) {
      const Histogram& histogram = violins[member].histograms[i];
      if (histogram.empty()) continue;
      const Place place = placeOf(i, member, violins.size());
      addViolin(histogram, place, outline);
      addMean(histogram, place, means);
    }
    plot.series.push_back(std::move(outline));
  }
  plot.series.push_back(std::move(means));
  return plot;
}

}  // namespace semantic_mht_slam
