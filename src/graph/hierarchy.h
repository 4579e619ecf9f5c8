#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "graph_state.h"
#include "loop_review.h"
#include "skeleton.h"

namespace semantic_mht_slam {

class StateArchive;

/// Keeps the skeleton of a graph: which node belongs to which chunk, condensed links along the drive, links for loop
/// closures, and carries what the skeleton finds back to the nodes.
class Hierarchy {
 public:
  explicit Hierarchy(const PoseGraphConfig& config);

  /// A hub for a new node if it begins a chunk, a link if it saw old landmarks again; call for every node once,
  /// after it was optimised with its neighbours.
  void extend(GraphState& graph, const LoopReview& review, int node);

  /// Landmarks were merged or split that these nodes saw.
  void touch(const std::set<int>& nodes) { touched_.insert(nodes.begin(), nodes.end()); }

  /// Links for touched nodes to where their landmarks, as they are now, were seen first.
  void linkTouched(const GraphState& graph, const LoopReview& review);

  /// A loop closure was removed: the skeleton is solved without it, and the nodes at its ends are touched.
  void drop(const GraphState& graph, int loop);

  /// The touched nodes and a few around each, ascending; none is touched any more.
  std::vector<int> takeTouched(const GraphState& graph);

  /// Takes over the states of loop closures and adds new priors; true if the skeleton has to be solved for them.
  bool update(GraphState& graph, const LoopReview& review);

  /// The positions in the outer frame that there are have brought their news already.
  void takePositionsAsKnown(const GraphState& graph);

  /// See `PoseGraph::coarseMarginals`.
  std::optional<std::vector<NodeMarginal>> marginals(GraphState& graph) const;

  /// Puts the hubs where their nodes are.
  void synchronize(const GraphState& graph);

  /// Solves the skeleton and moves all nodes accordingly.
  Skeleton::Outcome solve(GraphState& graph, const LoopReview& review, double max_seconds);

  /// Mahalanobis distance squared of a loop closure from the estimate of the skeleton, whose resolution its covariance
  /// includes.
  double gap(const GraphState& graph, int loop) const;

  /// Links that fit the estimate get their robust loss; links through landmarks that are far from it are switched off.
  void settle(const GraphState& graph);

  /// The piece of the drive, as long as the window, that was bent most since it was last optimised in full, as a list
  /// of its nodes and a few around it; empty if all are as good as straight.
  std::vector<int> takeBentPiece(const GraphState& graph);

  /// Everything was just optimised in full: nothing is left to repair or to bring in.
  void finishWhole(const GraphState& graph);

  bool isPending() const { return is_pending_; }

  /// Into an empty hierarchy, or out of one.
  void transfer(StateArchive& archive);

  /// Whether it may be that of a graph, as far as its first `nodes`.
  bool fits(const GraphState& graph, int nodes) const;

  /// True if links came or went or landmarks were merged since the skeleton was solved.
  bool hasNews() const { return is_pending_ || news_ > 0.0 || !touched_.empty(); }

 private:
  struct LoopLink {
    std::optional<int> link;  ///< none within a chunk: the window optimisations take care of it
    bool is_settled = false;

    void transfer(StateArchive& archive);
  };

  int chunkOf(int node) const { return node / config_.chunk_nodes; }
  int firstOf(int chunk) const { return chunk * config_.chunk_nodes; }
  int nearestHub(int node) const;
  double quietGap() const;
  void addHub(GraphState& graph, const LoopReview& review, int node);
  std::optional<int> addLiftedLink(const GraphState& graph, const LoopReview& review, const LoopConstraint& loop);
  void addSharedLandmarks(const GraphState& graph, const LoopReview& review, int node);
  void addPriors(GraphState& graph);
  void noticePositions(const GraphState& graph);
  std::unique_ptr<OuterFrame> outerOfHubs(const GraphState& graph) const;
  void moveNodes(GraphState& graph, const LoopReview& review);
  void moveChunk(GraphState& graph, const LoopReview& review, int chunk, const std::vector<Pose>& old_hubs);
  void addBend(int first, int last, const Vector6d& bend);

  const PoseGraphConfig& config_;
  Skeleton skeleton_;
  std::vector<LoopLink> loop_links_;        ///< by loop closure
  std::map<int, LoopLink> landmark_links_;  ///< through landmarks that were seen again, by the node that saw them
  std::set<int> touched_;                   ///< nodes that saw landmarks that were merged
  std::vector<std::size_t> prior_links_;    ///< per node: how many of its priors are in
  std::size_t priors_in_ = 0;               ///< sum of `prior_links_`
  std::size_t positions_in_ = 0;            ///< of the outer frame, once that is aligned
  std::vector<double> bend_;                ///< per piece of `window_nodes`, metres
  double news_ = 0.0;  ///< Mahalanobis distances squared that loop closures brought since the skeleton was solved
  bool is_pending_ = false;
};

}  // namespace semantic_mht_slam
