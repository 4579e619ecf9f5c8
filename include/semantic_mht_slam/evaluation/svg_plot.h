#pragma once

#include <string>
#include <vector>

namespace semantic_mht_slam {

/// One set of points of a plot. Points that are not finite are left out and interrupt the line.
struct PlotSeries {
  enum class Style { kLine, kDashed, kDots };

  std::string label;  ///< for the legend; empty: not in the legend
  std::vector<double> x;
  std::vector<double> y;  ///< as many as `x`
  std::string color;      ///< SVG colour; empty: the next of a palette that colour-blind readers can tell apart
  Style style = Style::kLine;
};

/// A plot of points against two axes.
struct Plot {
  std::string title;
  std::string x_label;  ///< with unit, as "x [m]"
  std::string y_label;
  bool equal_aspect = false;  ///< a unit is as long on one axis as on the other
  bool y_from_zero = false;   ///< the y axis includes 0
  std::vector<PlotSeries> series;
};

/// The plot as an SVG document; the same plot gives the same text. Throws std::invalid_argument for a series with
/// different numbers of x and y.
std::string svgPlot(const Plot& plot);

}  // namespace semantic_mht_slam
