#pragma once

#include <array>
#include <vector>

#include "semantic_mht_slam/mapping/centroid_bias.h"

namespace semantic_mht_slam {

/// Places of the coefficients: of each class that has a bias the range bias at every knot and the height bias at every
/// knot but the first, then what all stretches share of scale, direction and slope. Classes are counted among those.
struct BiasLayout {
  static constexpr std::array<double, 4> kKnots_m = {6.0, 15.0, 25.0, 40.0};
  static constexpr int kRangeKnots = 4;
  static constexpr int kPerClass = 2 * kRangeKnots - 1;
  static constexpr int kMotion = 3;  ///< scale, direction, slope

  int class_count = 0;

  int range(ClassIndex c, int knot) const { return c * kPerClass + knot; }
  int height(ClassIndex c, int knot) const { return c * kPerClass + kRangeKnots + knot - 1; }  ///< knot >= 1
  int motion(int i) const { return class_count * kPerClass + i; }
  int size() const { return class_count * kPerClass + kMotion; }
};

/// The two knots around a range and their shares; beyond the outer knots the line goes on, so that a scale error of the
/// odometry can be told from no bias that is linear in the range.
struct BiasBasis {
  int knot = 0;  ///< the nearer one
  double near_share = 1.0;
  double far_share = 0.0;
};

BiasBasis biasBasis(double range_m);

/// What the equations of a stretch know of the odometry.
struct BiasMotionNoise {
  OdometryNoise odometry;
  double scale_change_stddev = 0.01;  ///< of scale, direction and slope, between stretches
  int min_observations = 4;
};

/// Information that a stretch gives on the coefficients, landmarks and odometry errors eliminated.
struct BiasInformation {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd vector;
};

/// What is known of the first `count` unknowns whatever the others are (Schur complement). Only lower triangles are
/// read. Not finite if the others are not determined.
BiasInformation marginal(const BiasInformation& all, int count);

/// The stretch's classes are those of the layout. `prior` is the information on the coefficients so far, which helps to
/// find wrong associations.
BiasInformation biasInformation(const BiasStretch& stretch, const BiasLayout& layout, const BiasMotionNoise& noise,
                                const BiasInformation& prior);

}  // namespace semantic_mht_slam
