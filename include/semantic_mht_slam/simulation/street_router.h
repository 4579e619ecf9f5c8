#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/simulation/street_network.h"

namespace semantic_mht_slam {

/// A street driven in one direction.
struct Leg {
  int street = 0;
  bool reversed = false;

  bool operator==(const Leg& other) const { return street == other.street && reversed == other.reversed; }
};

/// Finds ways through a network that never turn on a street. Directed streets are numbered 2 * street + reversed.
/// Keeps a reference to the network.
class StreetRouter {
 public:
  explicit StreetRouter(const StreetNetwork& network);

  int count() const { return static_cast<int>(successors_.size()); }
  double length(int id) const { return network_.streets[static_cast<std::size_t>(id / 2)].length_m; }

  struct Way {
    std::vector<int> ids;
    double cost = 0.0;
  };

  /// The cheapest way from the end of `from` to the end of `goal`, which it includes (Dijkstra's algorithm). `costs`
  /// has one number above 0 for each directed street. Empty if there is none.
  std::optional<Way> find(int from, int goal, const std::vector<double>& costs) const;

 private:
  const StreetNetwork& network_;
  std::vector<std::vector<int>> successors_;
};

/// The same street in the other direction.
inline int oppositeOf(int id) {
  return id ^ 1;
}

/// The leg with this number.
inline Leg legOf(int id) {
  return {id / 2, id % 2 == 1};
}

}  // namespace semantic_mht_slam
