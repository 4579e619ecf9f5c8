#include "semantic_mht_slam/simulation/street_router.h"

#include <algorithm>
#include <limits>

namespace semantic_mht_slam {
namespace {

int startNode(const StreetNetwork& network, int id) {
  const Street& street = network.streets[static_cast<std::size_t>(id / 2)];
  return id % 2 == 0 ? street.from : street.to;
}

/// The unfinished number with the smallest cost, -1 if all others are out of reach.
int cheapest(const std::vector<double>& cost, const std::vector<bool>& done) {
  int best = -1;
  double best_cost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cost.size(); ++i) {
    if (done[i] || cost[i] >= best_cost) continue;
    best = static_cast<int>(i);
    best_cost = cost[i];
  }
  return best;
}

}  // namespace

StreetRouter::StreetRouter(const StreetNetwork& network) : network_(network), successors_(2 * network.streets.size()) {
  for (int id = 0; id < count(); ++id) {
    for (int next = 0; next < count(); ++next) {
      if (startNode(network, next) != startNode(network, oppositeOf(id)) || next == oppositeOf(id)) continue;
      successors_[static_cast<std::size_t>(id)].push_back(next);
    }
  }
}

std::optional<StreetRouter::Way> StreetRouter::find(int from, int goal, const std::vector<double>& costs) const {
  std::vector<double> cost(successors_.size(), std::numeric_limits<double>::infinity());
  std::vector<int> previous(successors_.size(), -1);  // stays -1 for the first street of a way
  std::vector<bool> done(successors_.size(), false);
  const auto relax = [&](int id, double id_cost, int as_previous) {
    for (const int next : successors_[static_cast<std::size_t>(id)]) {
      const std::size_t i = static_cast<std::size_t>(next);
      if (id_cost + costs[i] >= cost[i]) continue;
      cost[i] = id_cost + costs[i];
      previous[i] = as_previous;
    }
  };
  relax(from, 0.0, -1);
  for (int id = cheapest(cost, done); id >= 0 && id != goal; id = cheapest(cost, done)) {
    done[static_cast<std::size_t>(id)] = true;
    relax(id, cost[static_cast<std::size_t>(id)], id);
  }
  Way way;
  way.cost = cost[static_cast<std::size_t>(goal)];
  if (way.cost == std::numeric_limits<double>::infinity()) return std::nullopt;
  for (int id = goal; id >= 0; id = previous[static_cast<std::size_t>(id)]) way.ids.push_back(id);
  std::reverse(way.ids.begin(), way.ids.end());
  return way;
}

}  // namespace semantic_mht_slam
