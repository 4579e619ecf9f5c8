#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include <semantic_mht_slam/HypothesisTree.h>

namespace semantic_mht_slam {

/// A hypothesis as a line of a drawn tree: along x from where it branched off to where it branched itself, was dropped,
/// or is now. What it branched from is a line across at `begin`.
struct DrawnHypothesis {
  std::uint64_t id = 0;
  double begin = 0.0;  ///< 0: the oldest frame that is drawn, 1: now
  double end = 1.0;
  double row = 0.0;         ///< from 0; leaves and what lives have whole numbers of their own
  double parent_row = 0.0;  ///< its own if it has no parent in the drawing
  double weight = 0.0;      ///< of one that lives
  bool is_living = false;
  bool leads_to_living = false;  ///< it branched into one that lives
};

/// The tree of hypotheses of the present submap, as far as the topic `hypotheses` told: each message has the leaves
/// alone.
class HypothesisHistory {
 public:
  /// Takes the next message. One of another submap, or without hypotheses, begins anew.
  void add(const HypothesisTree& message);

  /// The newest `frames` frames of the tree, each hypothesis behind the one that it branched from.
  std::vector<DrawnHypothesis> drawn(int frames) const;

  /// Rows that the drawing has.
  static std::size_t rows(const std::vector<DrawnHypothesis>& drawn);

 private:
  struct Branch {
    std::uint64_t parent = 0;
    int born = 0;
    int end = 0;   ///< last frame that it is drawn to: that in which it branched, or the last one that told of it
    int told = 0;  ///< last message that has it
    double weight = 0.0;
  };

  void forget();
  std::set<std::uint64_t> wayToLiving() const;
  double place(std::uint64_t id, const std::map<std::uint64_t, std::vector<std::uint64_t>>& children, double& next_row,
               std::map<std::uint64_t, double>& rows) const;

  std::uint32_t submap_ = 0;
  int now_ = 0;  ///< frames of the submap
  std::map<std::uint64_t, Branch> branches_;
};

}  // namespace semantic_mht_slam
