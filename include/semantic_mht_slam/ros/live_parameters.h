#pragma once

#include <memory>

#include <ros/node_handle.h>

#include "semantic_mht_slam/app/live_config.h"

namespace semantic_mht_slam {

/// The parameters that dynamic_reconfigure may change while the node runs. Their initial values are those of the
/// parameter server in the namespace of the handle, as for every other parameter.
class LiveParameters {
 public:
  explicit LiveParameters(const ros::NodeHandle& handle);
  ~LiveParameters();

  /// The values as they are now; may be called from any thread.
  LiveConfig get() const;

  /// Number of changes so far, to see whether there was one.
  std::size_t version() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace semantic_mht_slam
