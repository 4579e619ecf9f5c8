#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "semantic_mht_slam/mapping/mapper.h"

namespace semantic_mht_slam {

/// Feeds a frame as the estimator does: a submap that is full ends before it, and another one begins. `earlier_map` is
/// asked for the surroundings of a submap that begins.
inline std::optional<FinishedSubmap> feed(Mapper& mapper, Frame frame, Rng& rng,
                                          const std::function<EarlierMap(const Pose&)>& earlier_map = {}) {
  std::optional<FinishedSubmap> finished;
  if (mapper.isFullAt(frame.T_odom_base)) finished = mapper.finish();
  if (!mapper.isOpen()) mapper.begin(frame.T_odom_base, earlier_map ? earlier_map(frame.T_odom_base) : EarlierMap{});
  mapper.add(std::move(frame), rng);
  return finished;
}

}  // namespace semantic_mht_slam
