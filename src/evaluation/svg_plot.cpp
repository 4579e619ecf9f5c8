#include "semantic_mht_slam/evaluation/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

constexpr double kWidth_px = 960.0;
constexpr double kHeight_px = 620.0;
constexpr double kLeft_px = 80.0;
constexpr double kRight_px = 740.0;  // the legend stands to the right of the axes
constexpr double kTop_px = 45.0;
constexpr double kBottom_px = 560.0;
constexpr double kLegendLine_px = 20.0;
constexpr std::size_t kLegendLetters = 24;
constexpr double kMinStep_px = 0.5;  // nearer points cannot be told apart
constexpr int kMaxTicks = 8;
constexpr std::array<const char*, 6> kPalette = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double size() const { return high - low; }
  void widen(double by) {
    low -= 0.5 * by;
    high += 0.5 * by;
  }
};

/// Data coordinates to pixels.
struct Axes {
  Range x;
  Range y;

  double column(double value) const { return kLeft_px + (kRight_px - kLeft_px) * (value - x.low) / x.size(); }
  double row(double value) const { return kBottom_px - (kBottom_px - kTop_px) * (value - y.low) / y.size(); }
};

std::string pixels(double value) {
  return formatFixed(value, 2);
}

/// The end of a long label, which tells files apart better than its beginning.
std::string shortened(const std::string& label) {
  if (label.size() <= kLegendLetters) return label;
  std::size_t begin = label.size() - kLegendLetters;
  while (begin < label.size() && (static_cast<unsigned char>(label[begin]) & 0xC0U) == 0x80U)
    ++begin;  // inside a letter
  return "\u2026" + label.substr(begin);
}

bool isDrawn(const PlotSeries& series, std::size_t i) {
  return std::isfinite(series.x[i]) && std::isfinite(series.y[i]);
}

/// An empty range becomes one around 0, a single value one around it, and all get a margin.
void makeUsable(Range& range) {
  if (!(range.low <= range.high)) range = {0.0, 1.0};
  if (!(range.size() > 1e-9 * std::max(std::abs(range.low), std::abs(range.high)))) {
    range.widen(std::max(1.0, 0.1 * std::abs(range.high)));
  }
  range.widen(0.06 * range.size());
}

Axes axesOf(const Plot& plot) {
  Axes axes;
  for (const PlotSeries& series : plot.series) {
    if (series.x.size() != series.y.size()) throw std::invalid_argument("a plot with more of one coordinate");
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!isDrawn(series, i)) continue;
      axes.x.include(series.x[i]);
      axes.y.include(series.y[i]);
    }
  }
  if (plot.y_from_zero) axes.y.include(0.0);
  makeUsable(axes.x);
  makeUsable(axes.y);
  if (plot.equal_aspect) {
    const double per_px = std::max(axes.x.size() / (kRight_px - kLeft_px), axes.y.size() / (kBottom_px - kTop_px));
    axes.x.widen(per_px * (kRight_px - kLeft_px) - axes.x.size());
    axes.y.widen(per_px * (kBottom_px - kTop_px) - axes.y.size());
  }
  return axes;
}

/// 1, 2 or 5 times a power of ten.
double tickStep(const Range& range) {
  const double rough = range.size() / kMaxTicks;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

struct Tick {
  double value = 0.0;
  std::string label;
};

std::vector<Tick> ticks(const Range& range) {
  const double step = tickStep(range);
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  std::vector<Tick> result;
  for (double i = std::ceil(range.low / step); i * step <= range.high; i += 1.0) {
    result.push_back({i * step, formatFixed(i * step, decimals)});
  }
  return result;
}

/// Text as it stands in the content or in an attribute of an element: markup characters become entities, control
/// characters blanks.
std::string escapedMarkup(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
    }
  }
  return result;
}

std::string text(double x, double y, const std::string& anchor, const std::string& content,
                 const std::string& more = "") {
  return "<text x=\"" + pixels(x) + "\" y=\"" + pixels(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
         escapedMarkup(content) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& attributes) {
  return "<line x1=\"" + pixels(x1) + "\" y1=\"" + pixels(y1) + "\" x2=\"" + pixels(x2) + "\" y2=\"" + pixels(y2) +
         "\" " + attributes + "/>\n";
}

std::string frame(const Plot& plot, const Axes& axes) {
  const std::string grid = "stroke=\"#dddddd\"";
  std::string svg;
  for (const Tick& tick : ticks(axes.x)) {
    svg += line(axes.column(tick.value), kTop_px, axes.column(tick.value), kBottom_px, grid);
    svg += text(axes.column(tick.value), kBottom_px + 18.0, "middle", tick.label);
  }
  for (const Tick& tick : ticks(axes.y)) {
    svg += line(kLeft_px, axes.row(tick.value), kRight_px, axes.row(tick.value), grid);
    svg += text(kLeft_px - 6.0, axes.row(tick.value) + 4.0, "end", tick.label);
  }
  svg += "<rect x=\"" + pixels(kLeft_px) + "\" y=\"" + pixels(kTop_px) + "\" width=\"" + pixels(kRight_px - kLeft_px) +
         "\" height=\"" + pixels(kBottom_px - kTop_px) + "\" fill=\"none\" stroke=\"#333333\"/>\n";
  const double middle = 0.5 * (kTop_px + kBottom_px);
  svg += text(0.5 * (kLeft_px + kRight_px), 28.0, "middle", plot.title, " font-size=\"16\"");
  svg += text(0.5 * (kLeft_px + kRight_px), kBottom_px + 42.0, "middle", plot.x_label);
  svg += text(22.0, middle, "middle", plot.y_label, " transform=\"rotate(-90 22.00 " + pixels(middle) + ")\"");
  return svg;
}

std::string strokeOf(const PlotSeries& series, const std::string& color) {
  const std::string dashes = series.style == PlotSeries::Style::kDashed ? " stroke-dasharray=\"6 4\"" : "";
  return "fill=\"none\" stroke=\"" + escapedMarkup(color) + "\" stroke-width=\"1.5\"" + dashes;
}

std::string dot(double x, double y, const std::string& color) {
  return "<circle cx=\"" + pixels(x) + "\" cy=\"" + pixels(y) + "\" r=\"2\" fill=\"" + escapedMarkup(color) + "\"/>\n";
}

std::string dots(const PlotSeries& series, const Axes& axes, const std::string& color) {
  std::string svg;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (isDrawn(series, i)) svg += dot(axes.column(series.x[i]), axes.row(series.y[i]), color);
  }
  return svg;
}

std::string curve(const PlotSeries& series, const Axes& axes, const std::string& color) {
  std::string path;
  bool pen_down = false;
  double last_x = 0.0;
  double last_y = 0.0;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!isDrawn(series, i)) {
      pen_down = false;
      continue;
    }
    const double x = axes.column(series.x[i]);
    const double y = axes.row(series.y[i]);
    const bool is_last = i + 1 == series.x.size() || !isDrawn(series, i + 1);
    if (pen_down && !is_last && std::hypot(x - last_x, y - last_y) < kMinStep_px) continue;
    path += (pen_down ? "L" : "M") + pixels(x) + " " + pixels(y);
    pen_down = true;
    last_x = x;
    last_y = y;
  }
  return path.empty() ? "" : "<path d=\"" + path + "\" " + strokeOf(series, color) + "/>\n";
}

std::string legendEntry(const PlotSeries& series, const std::string& color, double row_px) {
  const double x = kRight_px + 14.0;
  const std::string sign = series.style == PlotSeries::Style::kDots
                               ? dot(x + 11.0, row_px, color)
                               : line(x, row_px, x + 22.0, row_px, strokeOf(series, color));
  return sign + text(x + 28.0, row_px + 4.0, "start", shortened(series.label));
}

}  // namespace

std::string svgPlot(const Plot& plot) {
  const Axes axes = axesOf(plot);
  const std::string width = formatFixed(kWidth_px, 0);
  const std::string height = formatFixed(kHeight_px, 0);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
                    "\" viewBox=\"0 0 " + width + " " + height +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  svg += frame(plot, axes);
  std::size_t next_color = 0;
  double legend_px = kTop_px + 0.5 * kLegendLine_px;
  for (const PlotSeries& series : plot.series) {
    const std::string color = series.color.empty() ? kPalette[next_color++ % kPalette.size()] : series.color;
    svg += series.style == PlotSeries::Style::kDots ? dots(series, axes, color) : curve(series, axes, color);
    if (series.label.empty()) continue;
    svg += legendEntry(series, color, legend_px);
    legend_px += kLegendLine_px;
  }
  return svg + "</svg>\n";
}

}  // namespace semantic_mht_slam
