#pragma once

#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/evaluation/svg_plot.h"

namespace semantic_mht_slam {

/// How often each value occurred.
struct Violin {
  std::string label;
  std::vector<std::pair<double, double>> counts;  ///< value, number of times; by rising value
};

/// Mean of the values. NaN for an empty one.
double meanOf(const Violin& violin);

/// Violins side by side, as the paper shows numbers of hypotheses: the width at a value is its share, smoothed by a
/// Gaussian of half a unit, the widest place of each violin being equally wide; a line marks the mean, which the legend
/// names. Empty violins are left out.
Plot violinPlot(const std::string& title, const std::string& y_label, const std::vector<Violin>& violins);

}  // namespace semantic_mht_slam
