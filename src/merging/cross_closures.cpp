#include "cross_closures.h"

#include <algorithm>
#include <map>
#include <optional>

namespace semantic_mht_slam {
namespace {

/// Keyframes in the order in which they are asked: the nearest to what is known first.
class AskingOrder {
 public:
  AskingOrder(const MergeMap& map, const std::set<KeyframeId>& left_out, const BackEndConfig& config) : map_(map) {
    for (const KeyframeId k : map.map().keyframes().ids()) {
      const bool is_far = k.index() > 0 && map.driven_m(KeyframeId(k.index() - 1), k) > 2.0 * config.keyframe.spacing_m;
      const bool is_asked = is_far || k.index() % static_cast<std::size_t>(config.closure_stride) == 0;
      if (is_asked && left_out.count(k) == 0) open_.push_back({k, -1.0, 0});
    }
  }

  void noteAnchor(KeyframeId at, std::size_t anchor) {
    for (Asked& asked : open_) {
      const double way_m = map_.driven_m(asked.keyframe, at);
      if (asked.way_m >= 0.0 && way_m >= asked.way_m) continue;
      asked.way_m = way_m;
      asked.anchor = anchor;
    }
  }

  struct Asked {
    KeyframeId keyframe;
    double way_m = 0.0;  ///< from the anchor
    std::size_t anchor = 0;
  };

  std::optional<Asked> next() {
    const auto nearest =
        std::min_element(open_.begin(), open_.end(), [](const Asked& x, const Asked& y) { return x.way_m < y.way_m; });
    if (nearest == open_.end()) return std::nullopt;
    const Asked result = *nearest;
    open_.erase(nearest);
    return result;
  }

 private:
  const MergeMap& map_;
  std::vector<Asked> open_;
};

}  // namespace

std::vector<LoopClosureRecord> closuresBetween(const MergeMap& a, const MergeMap& b, std::vector<OverlapAnchor> anchors,
                                               const std::set<KeyframeId>& known, const MergeSettings& settings) {
  std::vector<LoopClosureRecord> result;
  if (anchors.empty()) return result;
  const BackEndConfig& back_end = settings.slam.back_end;
  AskingOrder order(b, known, back_end);
  for (std::size_t i = 0; i < anchors.size(); ++i) order.noteAnchor(anchors[i].b, i);
  while (const auto asked = order.next()) {
    const RegistrationPrior prior = priorAt(asked->keyframe, anchors[asked->anchor], a, b, settings);
    const Scene& scene = b.map().keyframes()[asked->keyframe].scene;
    const LoopClosureRecord* best = nullptr;
    auto found = findInMap(a.map(), scene, prior, settings.classes, settings.slam.registration, back_end.revisit);
    for (LoopClosureRecord& record : found) {
      record.query_keyframe = asked->keyframe;
      if (record.is_verified && (best == nullptr || record.score > best->score)) best = &record;
    }
    if (best == nullptr) continue;
    anchors.push_back({best->match_keyframe, asked->keyframe, best->T_match_query, best->score, 0.0});
    order.noteAnchor(asked->keyframe, anchors.size() - 1);
    for (const LoopClosureRecord& record : found) {
      if (record.is_verified) result.push_back(record);
    }
  }
  std::stable_sort(result.begin(), result.end(), [](const LoopClosureRecord& x, const LoopClosureRecord& y) {
    return x.query_keyframe < y.query_keyframe;
  });
  return result;
}

std::vector<OverlapAnchor> anchorsIn(const JoinedMap& joined, const JoinedMember& a, const JoinedMember& b,
                                     double stddev_m, double radius_m) {
  const auto pose = [&](const JoinedMember& member, KeyframeId k) -> const Pose& {
    return joined.parts.map.T_map_keyframe(KeyframeId(k.index() + member.first_keyframe));
  };
  std::vector<OverlapAnchor> anchors;
  for (const KeyframeId in_b : b.map->map().keyframes().ids()) {
    KeyframeId nearest;
    double nearest_m = radius_m;
    for (const KeyframeId in_a : a.map->map().keyframes().ids()) {
      const double distance_m = (pose(a, in_a).translation_m - pose(b, in_b).translation_m).head<2>().norm();
      if (distance_m >= nearest_m) continue;
      nearest = in_a;
      nearest_m = distance_m;
    }
    if (nearest.isNone()) continue;
    anchors.push_back({nearest, in_b, pose(a, nearest).inverse() * pose(b, in_b), 0.0, stddev_m});
  }
  return anchors;
}

Pose middleOf(const MergeMap& a, const MergeMap& b, const std::vector<LoopClosureRecord>& records) {
  constexpr std::size_t kMost = 60;
  std::vector<const LoopClosureRecord*> some;
  for (std::size_t i = 0; i < records.size(); i += 1 + records.size() / kMost) some.push_back(&records[i]);
  const auto motion = [&](const LoopClosureRecord& record) {
    return a.map().T_map_keyframe(record.match_keyframe) * record.T_match_query *
           b.map().T_map_keyframe(record.query_keyframe).inverse();
  };
  Pose best;
  double best_m = -1.0;
  for (const LoopClosureRecord* candidate : some) {
    const Pose T_a_b = motion(*candidate);
    double sum_m = 0.0;
    for (const LoopClosureRecord* other : some) {
      const Eigen::Vector3d& at_m = b.map().T_map_keyframe(other->query_keyframe).translation_m;
      sum_m += (T_a_b * at_m - motion(*other) * at_m).norm();
    }
    if (best_m >= 0.0 && sum_m >= best_m) continue;
    best = T_a_b;
    best_m = sum_m;
  }
  return best;
}

}  // namespace semantic_mht_slam
