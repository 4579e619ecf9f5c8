#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "semantic_mht_slam/mapping/fusion.h"
#include "semantic_mht_slam/mapping/odometry_stretch.h"
#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/models/frame.h"

namespace semantic_mht_slam {

class StateArchive;

/// Keeps of a submap what the odometry's errors are found out from: its poses some metres apart, or where it turned,
/// and what was seen there. Where a frame shows little, those that follow within a fraction of the way are taken, too.
class StationKeeping {
 public:
  /// A submap begins.
  void clear() { stations_.clear(); }

  /// The next frame of the submap, its place in the list of all; `motion` since the submap began.
  void add(std::size_t place, const Pose& T_submap_base, const Motion& motion, const Detections& detections,
           double spacing_m);

  /// A detection without bias and with its covariance, m^2, both in the base frame; none if it says nothing.
  using Corrected = std::function<std::optional<Detection>(const Detection&)>;

  /// The submap in pieces of some stations each, with its associations.
  std::vector<OdometryStretch> stretches(const std::vector<FusedAssociations>& associations,
                                         const Corrected& corrected) const;

  /// All that it keeps (see `StateArchive`).
  void transfer(StateArchive& archive);

  /// Whether all that it keeps is of detections of these frames.
  bool fits(const std::vector<Frame>& frames) const;

 private:
  struct Seen {
    std::size_t place = 0;
    std::size_t measurement = 0;  ///< in its frame
    Pose T_station_base;
    Detection detection;

    void transfer(StateArchive& archive);
  };
  struct Station {
    Pose T_submap_base;
    Motion motion;
    std::vector<Seen> seen;

    void transfer(StateArchive& archive);
  };

  std::vector<Station> stations_;
};

}  // namespace semantic_mht_slam
