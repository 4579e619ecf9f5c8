#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/map/scene.h"

namespace semantic_mht_slam {

/// Share of each class of the table: entries of at least 0 that sum to 1, or all 0 if there was nothing to count.
using ClassHistogram = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxClasses, 1>;

/// ln 2, the largest Jensen-Shannon divergence.
constexpr double kMaxDivergence = 0.69314718055994530942;

/// Class histogram of what one keyframe sees. `classes` is the size of the class table.
/// Throws std::invalid_argument for a class index outside the table and for more than kMaxClasses classes.
ClassHistogram classHistogram(const Scene& scene, int classes);

/// Class histogram of landmarks, each counted once in its most likely class.
/// Throws std::invalid_argument as above.
ClassHistogram classHistogram(const std::vector<MixtureLandmark>& landmarks, int classes);

/// True for a histogram of nothing, which is like no other one.
bool isEmpty(const ClassHistogram& histogram);

/// What one class adds to the Jensen-Shannon divergence, for shares `a` and `b` of at least 0:
/// (a ln(a/m) + b ln(b/m)) / 2 with m = (a + b) / 2. At least 0, zero where a = b, and rising with the distance of
/// either share from the other; that makes it a lower bound on a box of shares, as a kd-tree needs it.
double divergenceTerm(double a, double b);

/// Jensen-Shannon divergence in nats (Lin 1991): symmetric, in [0, ln 2], 0 for equal histograms. An empty histogram
/// has the divergence ln 2 from every one, itself included. Throws std::invalid_argument for histograms of different
/// sizes.
double jensenShannonDivergence(const ClassHistogram& a, const ClassHistogram& b);

/// Euclidean distance of two histograms, in [0, sqrt 2]; sqrt 2 if one of them is empty.
/// Throws std::invalid_argument for histograms of different sizes.
double euclideanDistance(const ClassHistogram& a, const ClassHistogram& b);

}  // namespace semantic_mht_slam
