#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// A landmark of a map or of the truth. The third axis points up.
struct PointLandmark {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  bool has_height = true;  ///< false: z is not known
  std::string class_name;  ///< empty: not known
};

/// How mapped landmarks are compared with true ones.
struct LandmarkComparison {
  double radius_m = 1.0;    ///< largest distance in the plane at which a landmark counts as found
  bool match_class = true;  ///< landmarks of different known classes are never the same
  Pose T_truth_map;         ///< map to truth, see `rigidAlignment` and `planarAlignment`
  double driven_length_m = std::numeric_limits<double>::quiet_NaN();  ///< for figures per kilometre
};

/// A true landmark and the mapped one that stands for it.
struct LandmarkMatch {
  std::size_t truth = 0;
  std::size_t mapped = 0;
  double distance_m = 0.0;  ///< in the plane
};

/// How well a map holds the true landmarks. NaN where a figure is not defined.
struct LandmarkError {
  static constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

  std::size_t true_landmarks = 0;
  std::size_t mapped_landmarks = 0;
  std::vector<LandmarkMatch> matches;  ///< one to one, by rising distance
  std::size_t duplicates = 0;          ///< mapped without a match, but near a true landmark: mapped again
  std::size_t ghosts = 0;              ///< mapped where nothing is
  double recall = kUndefined;          ///< matches / true landmarks
  double precision = kUndefined;       ///< matches / mapped landmarks
  double duplicates_per_true = kUndefined;
  double ghosts_per_km = kUndefined;
  double rmse_m = kUndefined;  ///< of the matches' distances in the plane
  double median_m = kUndefined;
  double height_rmse_m = kUndefined;  ///< of the matches where both heights are known
};

/// Compares a map with the truth. Matches are made greedily, the nearest pair first; ties go to the landmark that comes
/// first in its list. Throws std::invalid_argument for a radius or a length that is not positive and for positions that
/// are not finite.
LandmarkError landmarkError(const std::vector<PointLandmark>& truth, const std::vector<PointLandmark>& map,
                            const LandmarkComparison& comparison);

}  // namespace semantic_mht_slam
