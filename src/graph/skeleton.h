#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include "semantic_mht_slam/graph/pose_graph.h"

#include "ceres_manifold.h"
#include "cost_functions.h"
#include "outer_frame.h"

namespace semantic_mht_slam {

class StateArchive;

/// Coarse pose graph: a hub for the first node of every chunk and condensed factors between them. The Ceres problem
/// is kept from call to call; links are added and taken out in place.
class Skeleton {
 public:
  explicit Skeleton(double cauchy_scale);

  int addHub(const Pose& pose);
  int hubs() const { return static_cast<int>(blocks_.size()); }
  Pose pose(int hub) const;
  void setPose(int hub, const Pose& pose);

  /// Joins two different hubs, or a hub with the world (`kWorld` as `from`), without robust loss. Returns the number
  /// of the link, which is not active yet.
  int addLink(int from, int to, const Pose& T_from_to, const PoseCov& cov,
              const SharedErrors& shared_errors = SharedErrors::Zero());
  bool hasLink(int link) const { return link >= 0 && link < static_cast<int>(links_.size()); }
  void setActive(int link, bool is_active);
  bool isActive(int link) const { return links_[link].id != nullptr; }

  /// A link that is far from the estimate when it comes must pull with its full weight: under a robust loss it would
  /// hardly move anything. It gets its loss once it fits.
  void setRobust(int link, bool is_robust);
  static constexpr int kWorld = -1;

  /// Mahalanobis distance squared of a link from the estimate.
  double mahalanobisSq(int link) const;

  /// How far the hubs may be off by the links that are active and the positions of an outer frame, if there is one,
  /// whose nodes are the hubs; empty if they are not determined.
  std::optional<std::vector<NodeMarginal>> marginals(const OuterFrame* outer) const;

  struct Outcome {
    std::string failure;  ///< empty, or why nothing was changed
    int iterations = 0;
    bool converged = false;
    bool out_of_time = false;  ///< stopped by the clock
  };
  /// An outer frame takes part, and is moved, if there is one.
  Outcome optimize(int max_iterations, double max_seconds, OuterFrame* outer);

  /// Hubs and links with the order in which the solver sees them; into an empty skeleton, or out of one.
  void transfer(StateArchive& archive);

 private:
  struct Link {
    std::unique_ptr<RelativePose3Cost> cost;
    SharedErrors shared_errors = SharedErrors::Zero();
    int from = 0;
    int to = 0;
    bool is_robust = false;
    ceres::ResidualBlockId id = nullptr;  ///< none: not active

    void transfer(StateArchive& archive);
  };

  std::vector<int> activeLinks() const;

  const double* block(int hub) const { return hub == kWorld ? world_.data() : blocks_[hub].data(); }
  double* block(int hub) { return hub == kWorld ? world_.data() : blocks_[hub].data(); }

  std::deque<std::array<double, kPoseBlock>> blocks_;
  std::deque<Link> links_;
  std::array<double, kPoseBlock> world_{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  ceres::CauchyLoss loss_;
  PoseManifold manifold_;
  ceres::Problem problem_;
};

}  // namespace semantic_mht_slam
