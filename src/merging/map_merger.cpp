#include "semantic_mht_slam/merging/map_merger.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include "semantic_mht_slam/common/error.h"

#include "cross_closures.h"
#include "merge_description.h"

namespace semantic_mht_slam {
namespace {

constexpr double kDoubtful = 0.5;  // posterior of what would be certain if no place looked like another
constexpr std::size_t kFewestClosures = 2;
constexpr double kJoinedStddev_m = 1.0;  // of two maps in a joined one, where no closure ties them

/// The closures between two maps, as they number their keyframes.
struct PairClosures {
  std::size_t pair = 0;  ///< place in the list of pairs; none of the decided ones: the number of pairs
  std::size_t a = 0;
  std::size_t b = 0;
  std::vector<LoopClosureRecord> records;  ///< query in b
};

class Merging {
 public:
  Merging(std::vector<MergeMap>& maps, const MergeSettings& settings, const MergeConfig& config,
          const MergeProgress& progress, PairMemory& memory)
      : maps_(maps), settings_(settings), config_(config), progress_(progress), memory_(memory) {
    memory_.expect(settings.range_factor);
  }

  MergeResult run() {
    const double factor = settings_.range_factor;
    for (MergeMap& map : maps_) {
      say("looking at " + map.name());
      map.prepare(settings_, config_.window_m * factor, config_.window_spacing_m * factor, config_.tile_landmarks,
                  config_.min_tile_landmarks);
    }
    comparePairs();
    while (!joinGroups()) {
    }
    describe(maps_, result_);
    return std::move(result_);
  }

 private:
  void say(const std::string& step) const {
    if (progress_) progress_(step);
  }

  const ComparedPair& compare(const MergeMap& a, const MergeMap& b) const {
    if (const ComparedPair* known = memory_.find(a.name(), b.name())) return *known;
    say("comparing " + a.name() + " with " + b.name());
    ComparedPair pair{findOverlap(a, b, settings_, config_), {}};
    if (pair.overlap.is_decided) {
      pair.closures = closuresBetween(a, b, pair.overlap.hypotheses.front().anchors, {}, settings_);
    }
    return memory_.keep(a.name(), b.name(), std::move(pair));
  }

  void comparePairs() {
    for (std::size_t a = 0; a < maps_.size(); ++a) {
      for (std::size_t b = a + 1; b < maps_.size(); ++b) {
        const ComparedPair& compared = compare(maps_[a], maps_[b]);
        MergedPair pair{a, b, compared.overlap, false, false, 0.0, 0, ""};
        pair.is_decided = pair.overlap.is_decided;
        pair.reason = pair.overlap.reason;
        pair.posterior = pair.overlap.prob;
        if (!pair.is_decided && pair.posterior >= config_.join_prob) pair.posterior = kDoubtful;
        if (pair.is_decided && compared.closures.size() < kFewestClosures) {
          pair.is_decided = false;
          pair.reason = "hardly any keyframe of one is found in the other";
        }
        closures_.push_back({result_.pairs.size(), a, b, compared.closures});
        result_.pairs.push_back(std::move(pair));
      }
    }
  }

  const PairClosures& closuresOf(std::size_t a, std::size_t b) const {
    const auto found = std::find_if(closures_.begin(), closures_.end(), [&](const PairClosures& closures) {
      return closures.a == std::min(a, b) && closures.b == std::max(a, b);
    });
    return *found;
  }

  bool isDecided(std::size_t a, std::size_t b) const { return result_.pairs[closuresOf(a, b).pair].is_decided; }

  /// Maps that decided pairs hold together with `first`, and where each lies in its frame.
  std::map<std::size_t, Pose> groupOf(std::size_t first) const {
    std::map<std::size_t, Pose> placed{{first, Pose::identity()}};
    std::deque<std::size_t> open{first};
    while (!open.empty()) {
      const std::size_t from = open.front();
      open.pop_front();
      for (std::size_t to = 0; to < maps_.size(); ++to) {
        if (to == from || placed.count(to) > 0 || !isDecided(from, to)) continue;
        const PairClosures& closures = closuresOf(from, to);
        const Pose T_a_b = middleOf(maps_[closures.a], maps_[closures.b], closures.records);
        placed[to] = placed[from] * (closures.a == from ? T_a_b : T_a_b.inverse());
        open.push_back(to);
      }
    }
    return placed;
  }

  std::vector<JoinedMember> membersOf(const std::map<std::size_t, Pose>& placed) const {
    std::vector<JoinedMember> members;
    for (const auto& [map, T_joined_map] : placed) members.push_back({&maps_[map], T_joined_map, 0, 0, 0});
    return members;
  }

  /// False if a pair was refuted; then all is joined again without it.
  bool joinGroups() {
    result_.groups.clear();
    std::set<std::size_t> done;
    for (std::size_t first = 0; first < maps_.size(); ++first) {
      if (done.count(first) > 0) continue;
      const std::map<std::size_t, Pose> placed = groupOf(first);
      MergedGroup group;
      for (const auto& entry : placed) group.maps.push_back(entry.first);
      done.insert(group.maps.begin(), group.maps.end());
      if (!join(placed, group)) return false;
      result_.groups.push_back(std::move(group));
    }
    std::stable_sort(result_.groups.begin(), result_.groups.end(),
                     [](const MergedGroup& x, const MergedGroup& y) { return x.maps.size() > y.maps.size(); });
    return true;
  }

  bool join(const std::map<std::size_t, Pose>& placed, MergedGroup& group) {
    std::vector<PairClosures> closures;
    for (const PairClosures& of_pair : closures_) {
      if (placed.count(of_pair.a) > 0 && placed.count(of_pair.b) > 0 && result_.pairs[of_pair.pair].is_decided) {
        closures.push_back(of_pair);
      }
    }
    const bool is_any_joined =
        std::any_of(result_.pairs.begin(), result_.pairs.end(), [](const MergedPair& pair) { return pair.is_decided; });
    if (placed.size() == 1 && (is_any_joined || placed.begin()->first > 0)) return true;
    say("joining " + std::to_string(placed.size()) + " maps");
    group.joined = joinMaps(membersOf(placed), numbered(group, closures), settings_);
    if (placed.size() == 1) return true;
    if (!areBorneOut(group, closures)) return false;
    if (addRevisits(group, closures)) {
      group.joined = joinMaps(membersOf(placed), numbered(group, closures), settings_);
      if (!areBorneOut(group, closures)) return false;
    }
    countClosures(group);
    return true;
  }

  static std::size_t placeIn(const MergedGroup& group, std::size_t map) {
    return static_cast<std::size_t>(std::lower_bound(group.maps.begin(), group.maps.end(), map) - group.maps.begin());
  }

  static std::vector<CrossClosure> numbered(const MergedGroup& group, const std::vector<PairClosures>& closures) {
    std::vector<CrossClosure> result;
    for (const PairClosures& of_pair : closures) {
      for (const LoopClosureRecord& record : of_pair.records) {
        result.push_back({placeIn(group, of_pair.b), placeIn(group, of_pair.a), record});
      }
    }
    return result;
  }

  /// What is seen of one map from another where the joined poses say that they are near each other.
  bool addRevisits(const MergedGroup& group, std::vector<PairClosures>& closures) {
    say("looking for further revisits");
    const double radius_m = 0.5 * settings_.slam.back_end.revisit.range_m;
    bool is_any_new = false;
    for (std::size_t i = 0; i < group.maps.size(); ++i) {
      for (std::size_t k = i + 1; k < group.maps.size(); ++k) {
        const MergeMap& a = maps_[group.maps[i]];
        const MergeMap& b = maps_[group.maps[k]];
        auto known = std::find_if(closures.begin(), closures.end(), [&](const PairClosures& of_pair) {
          return of_pair.a == group.maps[i] && of_pair.b == group.maps[k];
        });
        const std::vector<OverlapAnchor> anchors =
            anchorsIn(*group.joined, group.joined->members[i], group.joined->members[k],
                      known == closures.end() ? kJoinedStddev_m * settings_.range_factor : 0.0, radius_m);
        std::set<KeyframeId> left_out;
        for (const KeyframeId keyframe : b.map().keyframes().ids()) left_out.insert(keyframe);
        for (const OverlapAnchor& anchor : anchors) left_out.erase(anchor.b);
        if (known != closures.end()) {
          for (const LoopClosureRecord& record : known->records) left_out.insert(record.query_keyframe);
        }
        std::vector<LoopClosureRecord> found = closuresBetween(a, b, anchors, left_out, settings_);
        if (found.empty()) continue;
        is_any_new = true;
        if (known == closures.end()) {
          closures.push_back({result_.pairs.size(), group.maps[i], group.maps[k], std::move(found)});
        } else {
          known->records.insert(known->records.end(), found.begin(), found.end());
        }
      }
    }
    return is_any_new;
  }

  /// Closures between two members of a group: how many hold, and how many there are.
  std::pair<int, int> holding(const MergedGroup& group, std::size_t a, std::size_t b) const {
    const std::size_t in_a = placeIn(group, a);
    const std::size_t in_b = placeIn(group, b);
    const auto memberOf = [&](KeyframeId keyframe) {
      std::size_t member = group.joined->members.size() - 1;
      while (keyframe.index() < group.joined->members[member].first_keyframe) --member;
      return member;
    };
    int held = 0;
    int all = 0;
    for (const LoopClosureRecord& closure : group.joined->parts.map.closures()) {
      if (!closure.is_verified || memberOf(closure.match_keyframe) != in_a) continue;
      if (memberOf(closure.query_keyframe) != in_b) continue;
      ++all;
      if (closure.is_accepted) ++held;
    }
    return {held, all};
  }

  /// Refutes the pair whose closures hold least, if less than the least share do.
  bool areBorneOut(const MergedGroup& group, const std::vector<PairClosures>& closures) {
    MergedPair* worst = nullptr;
    double worst_share = config_.min_holding;
    for (const PairClosures& of_pair : closures) {
      if (of_pair.pair == result_.pairs.size()) continue;
      const auto [held, all] = holding(group, of_pair.a, of_pair.b);
      const double share = all == 0 ? 0.0 : static_cast<double>(held) / all;
      if (share >= worst_share) continue;
      worst = &result_.pairs[of_pair.pair];
      worst_share = share;
      worst->reason =
          "refuted by the joint graph: " + std::to_string(held) + " of " + std::to_string(all) + " closures hold";
    }
    if (worst == nullptr) return true;
    worst->is_decided = false;
    return false;
  }

  void countClosures(const MergedGroup& group) {
    for (MergedPair& pair : result_.pairs) {
      const auto has = [&](std::size_t map) { return std::binary_search(group.maps.begin(), group.maps.end(), map); };
      if (has(pair.a) && has(pair.b)) pair.closures = holding(group, pair.a, pair.b).first;
    }
  }

  std::vector<MergeMap>& maps_;
  const MergeSettings& settings_;
  const MergeConfig& config_;
  const MergeProgress& progress_;
  PairMemory& memory_;
  std::vector<PairClosures> closures_;
  MergeResult result_;
};

}  // namespace

MergeSettings mergeSettings(const std::vector<MergeMap>& maps, const SlamConfig& config, const ClassTable& classes) {
  std::vector<double> factors;
  for (const MergeMap& map : maps) factors.push_back(map.parts().range_factor);
  std::sort(factors.begin(), factors.end());
  const double factor = factors.empty() ? 1.0 : factors[factors.size() / 2];
  return {factor == 1.0 ? config : fittedTo(config, factor), classes, factor};
}

MergeResult mergeMaps(std::vector<MergeMap>& maps, const SlamConfig& config, const ClassTable& classes,
                      const MergeConfig& merge, const MergeProgress& progress, PairMemory* memory) {
  for (const MergeMap& map : maps) {
    if (map.map().submaps().empty()) throw InputError(map.name() + ": has no finished submap");
  }
  const MergeSettings settings = mergeSettings(maps, config, classes);
  PairMemory of_this_time;
  return Merging(maps, settings, merge, progress, memory == nullptr ? of_this_time : *memory).run();
}

}  // namespace semantic_mht_slam
