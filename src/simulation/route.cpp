#include "semantic_mht_slam/simulation/route.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

constexpr double kRevisitCost = 3.0;
constexpr double kUnwantedCost = 10.0;
constexpr int kCandidates = 4;  // goals compared at a time

/// What a street is to the streets driven before it.
enum class LegKind { kNew, kSameDirection, kOppositeDirection };

class RoutePlanner {
 public:
  RoutePlanner(const StreetNetwork& network, const RouteConfig& config, double length_m, const Rng& rng)
      : network_(network),
        config_(config),
        length_m_(length_m),
        rng_(rng),
        router_(network),
        driven_(2 * network.streets.size(), false) {}

  std::vector<Leg> plan() {
    drive(static_cast<int>(rng_.index(driven_.size())));
    const double planned_m = config_.round_m > 0.0 ? std::min(config_.round_m, length_m_) : length_m_;
    while (total_m_ < planned_m) {
      const LegKind kind = mostBehind();
      if (kind == LegKind::kNew) {
        explore();
      } else {
        revisit(kind);
      }
    }
    if (total_m_ < length_m_) repeat();
    std::vector<Leg> legs;
    for (const int id : history_) legs.push_back(legOf(id));
    return legs;
  }

 private:
  bool driven(int id) const { return driven_[static_cast<std::size_t>(id)]; }

  LegKind kindOf(int id) const {
    if (driven(id)) return LegKind::kSameDirection;
    return driven(oppositeOf(id)) ? LegKind::kOppositeDirection : LegKind::kNew;
  }

  void drive(int id) {
    kind_length_m_[static_cast<std::size_t>(kindOf(id))] += router_.length(id);
    history_.push_back(id);
    start_m_.push_back(total_m_);
    total_m_ += router_.length(id);
    driven_[static_cast<std::size_t>(id)] = true;
  }

  /// The kind of street that is most metres behind its share.
  LegKind mostBehind() const {
    const double same = config_.same_direction_fraction;
    const double opposite = config_.opposite_direction_fraction;
    const std::array<double, 3> share = {1.0 - same - opposite, same, opposite};
    LegKind best = LegKind::kNew;
    double best_deficit = share[0] * total_m_ - kind_length_m_[0];
    for (const LegKind kind : {LegKind::kSameDirection, LegKind::kOppositeDirection}) {
      const std::size_t i = static_cast<std::size_t>(kind);
      const double deficit = share[i] * total_m_ - kind_length_m_[i];
      if (share[i] == 0.0 || deficit <= best_deficit || total_m_ < config_.min_loop_m) continue;
      best = kind;
      best_deficit = deficit;
    }
    return best;
  }

  /// Costs of streets on the way to a goal: those not driven yet are preferred, and those of a kind that is not wanted
  /// at all are avoided.
  std::vector<double> costs() const {
    const auto revisit_cost = [](double share) { return share == 0.0 ? kUnwantedCost : kRevisitCost; };
    const std::array<double, 3> kind_costs = {1.0, revisit_cost(config_.same_direction_fraction),
                                              revisit_cost(config_.opposite_direction_fraction)};
    std::vector<double> costs;
    costs.reserve(driven_.size());
    for (int id = 0; id < router_.count(); ++id) {
      costs.push_back(router_.length(id) * kind_costs[static_cast<std::size_t>(kindOf(id))]);
    }
    return costs;
  }

  /// Drives to the new street that is easiest to reach among a few.
  void explore() {
    std::vector<int> goals;
    for (int id = 0; id < router_.count(); ++id) {
      if (kindOf(id) == LegKind::kNew) goals.push_back(id);
    }
    const std::optional<std::size_t> chosen = driveToOneOf(goals);
    if (chosen) return;
    throw InputError(
        "route.length = " + formatDouble(config_.length_m) + " m is too long: the network has " +
        formatFixed(network_.totalLength(), 0) +
        " m of streets; lower it, raise the revisited fractions, or raise network.columns or network.rows");
  }

  /// Drives to a part of the route that is at least `min_loop_m` back and follows it, forwards or backwards.
  void revisit(LegKind kind) {
    const bool backwards = kind == LegKind::kOppositeDirection;
    std::vector<std::size_t> places;
    std::vector<int> goals;
    for (std::size_t i = 0; i < history_.size(); ++i) {
      const int goal = backwards ? oppositeOf(history_[i]) : history_[i];
      if (total_m_ - start_m_[i] < config_.min_loop_m || (backwards && driven(goal))) continue;
      places.push_back(i);
      goals.push_back(goal);
    }
    if (goals.empty()) return explore();
    const std::optional<std::size_t> chosen = driveToOneOf(goals);
    if (!chosen) {
      const std::string field = backwards ? "route.opposite_direction_fraction" : "route.same_direction_fraction";
      throw InputError(field +
                       ": the network has no way back to a street driven before; raise network.columns or "
                       "network.rows, or set it to 0");
    }
    const double end_m = total_m_ + config_.revisit_run_m * rng_.uniform(0.5, 1.5);
    follow(places[*chosen], backwards, end_m);
  }

  /// Follows the route as it was driven after (or, backwards, before) entry `place`.
  void follow(std::size_t place, bool backwards, double end_m) {
    const std::size_t known = history_.size();
    while (total_m_ < end_m) {
      if (backwards ? place == 0 : place + 1 == known) return;
      place = backwards ? place - 1 : place + 1;
      const int next = backwards ? oppositeOf(history_[place]) : history_[place];
      if (backwards && driven(next)) return;
      drive(next);
    }
  }

  /// Draws a few goals, drives to the one at the least cost; its index, or empty if none can be reached.
  std::optional<std::size_t> driveToOneOf(const std::vector<int>& goals) {
    const std::vector<double> street_costs = costs();
    std::vector<std::size_t> order(goals.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::optional<std::size_t> chosen;
    StreetRouter::Way best;
    int reached = 0;
    for (std::size_t i = 0; i < order.size() && reached < kCandidates; ++i) {
      std::swap(order[i], order[i + rng_.index(order.size() - i)]);
      const auto way = router_.find(history_.back(), goals[order[i]], street_costs);
      if (!way) continue;
      ++reached;
      if (chosen && way->cost >= best.cost) continue;
      chosen = order[i];
      best = *way;
    }
    for (const int id : best.ids) drive(id);
    return chosen;
  }

  /// Goes back to the beginning and makes the drive again, round after round.
  void repeat() {
    std::vector<double> lengths;
    for (int id = 0; id < router_.count(); ++id) lengths.push_back(router_.length(id));
    const auto back = router_.find(history_.back(), history_.front(), lengths);
    if (!back) throw InputError("route.round: the network has no way back; raise network.columns or network.rows");
    std::vector<int> round = back->ids;
    round.insert(round.end(), history_.begin() + 1, history_.end());
    for (std::size_t i = 0; total_m_ < length_m_; i = (i + 1) % round.size()) drive(round[i]);
  }

  const StreetNetwork& network_;
  const RouteConfig& config_;
  double length_m_;
  Rng rng_;
  StreetRouter router_;
  std::vector<int> history_;     // numbers of the directed streets driven
  std::vector<double> start_m_;  // distance driven before each of them
  std::vector<bool> driven_;
  std::array<double, 3> kind_length_m_ = {0.0, 0.0, 0.0};  // by LegKind
  double total_m_ = 0.0;
};

}  // namespace

std::vector<Leg> planRoute(const StreetNetwork& network, const RouteConfig& config, double length_m, Rng rng) {
  return RoutePlanner(network, config, length_m, rng).plan();
}

}  // namespace semantic_mht_slam
