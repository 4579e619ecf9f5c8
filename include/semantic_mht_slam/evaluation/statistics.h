#pragma once

#include <cstdint>
#include <vector>

namespace semantic_mht_slam {

/// Figures of a list of numbers; NaN for an empty list.
double mean(const std::vector<double>& values);
double rootMeanSquare(const std::vector<double>& values);

/// Of the list itself: the mean square deviation is divided by its length.
double standardDeviation(const std::vector<double>& values);

/// The middle value, or the mean of the two in the middle.
double median(std::vector<double> values);

/// Part of a whole; 0 of nothing.
double share(std::int64_t part, std::int64_t whole);

}  // namespace semantic_mht_slam
