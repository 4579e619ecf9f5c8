#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

class StateArchive;

/// How densely objects of a class stand round one of them (the second-order intensity of a point process: Illian et
/// al., Statistical Analysis and Modelling of Spatial Point Patterns, 2008, chapter 4), and after how many looks at one
/// its neighbours are seen. Learned from finished submaps. A detection beside a landmark that another detection shows
/// is a part of the same object, or of a neighbour: chairs round a table have many at half a metre, parked cars none.
class NeighbourDensity {
 public:
  /// How soon neighbours are seen is learned from those within `reach_m`.
  NeighbourDensity(int class_count, double reach_m);

  /// Takes the landmarks that were seen in a finished submap, each as far as it exists, and its associations in the
  /// order of frames.
  void add(SubmapId submap, const std::vector<MixtureLandmark>& landmarks,
           const std::vector<DetectionAssociation>& associations);

  /// log density of other objects of the class at a place relative to an object of it, 1/m^3, axes with z up; -infinity
  /// where none has been seen.
  double logDensity(ClassIndex class_index, const Eigen::Vector3d& offset_m) const;

  /// log probability that a neighbour of an object is seen for the first time after so many looks at that object. The
  /// prior takes every probability of detection for as likely, and counts for one look.
  double logFirstProb(ClassIndex class_index, int looks) const;

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  static constexpr std::size_t kRings = 16;
  static constexpr std::size_t kLookBins = 10;

  struct Neighbours {
    double objects = 0.0;
    std::array<double, kRings> pairs{};     ///< by distance; each object of a pair has the other one
    std::array<double, kLookBins> looks{};  ///< at an object of a pair whose other one had not been seen
    std::array<double, kLookBins> first{};  ///< of these, with which it was seen
    double all_pairs = 0.0;
    double height_squares_m2 = 0.0;  ///< of the height between the objects of all pairs

    void transfer(StateArchive& archive);
  };

  static std::size_t binOf(int looks);
  static void addPair(const MixtureLandmark& of, const MixtureLandmark& other, Neighbours& neighbours);
  static void addLooks(const std::vector<std::size_t>& frames, int looks_before, std::size_t first_of_other,
                       double exist, Neighbours& neighbours);

  double reach_m_;
  std::vector<Neighbours> of_class_;
};

}  // namespace semantic_mht_slam
