#include "semantic_mht_slam/ros/hypothesis_history.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace semantic_mht_slam {
namespace {

constexpr int kKept = 200;  // frames that a hypothesis that was dropped is remembered

}  // namespace

void HypothesisHistory::add(const HypothesisTree& message) {
  if (message.submap != submap_ || message.hypotheses.empty()) *this = {};
  submap_ = message.submap;
  if (message.hypotheses.empty()) return;
  ++now_;
  for (const Hypothesis& hypothesis : message.hypotheses) {
    const auto [found, is_new] = branches_.try_emplace(hypothesis.id);
    Branch& branch = found->second;
    if (is_new) {
      branch.parent = hypothesis.parent_id;
      branch.born = std::max(0, now_ - static_cast<int>(hypothesis.age));
      const auto parent = branches_.find(branch.parent);
      if (parent != branches_.end()) parent->second.end = std::max(parent->second.end, branch.born);
    }
    branch.end = branch.told = now_;
    branch.weight = hypothesis.weight;
  }
  forget();
}

/// What was dropped long ago, or ended there without leading to one that lives.
void HypothesisHistory::forget() {
  const std::set<std::uint64_t> kept = wayToLiving();
  for (auto branch = branches_.begin(); branch != branches_.end();) {
    const bool is_old = branch->second.end < now_ - kKept;
    branch = is_old && kept.count(branch->first) == 0 ? branches_.erase(branch) : std::next(branch);
  }
}

/// The living hypotheses and all that they come from.
std::set<std::uint64_t> HypothesisHistory::wayToLiving() const {
  std::set<std::uint64_t> way;
  for (const auto& [id, branch] : branches_) {
    if (branch.told < now_) continue;
    for (auto next = branches_.find(id); next != branches_.end() && way.insert(next->first).second;) {
      next = branches_.find(next->second.parent);
    }
  }
  return way;
}

/// Gives rows to a hypothesis and to what comes from it; returns its own. What lives has a row for itself, that its
/// label lies on no other one; what only leads there is in the middle of its children.
double HypothesisHistory::place(std::uint64_t id, const std::map<std::uint64_t, std::vector<std::uint64_t>>& children,
                                double& next_row, std::map<std::uint64_t, double>& rows) const {
  const auto found = children.find(id);
  const bool is_living = branches_.at(id).told == now_;
  if (is_living || found == children.end()) rows[id] = next_row++;
  if (found == children.end()) return rows[id];
  double first = 0.0;
  double last = 0.0;
  for (std::size_t i = 0; i < found->second.size(); ++i) {
    last = place(found->second[i], children, next_row, rows);
    if (i == 0) first = last;
  }
  if (!is_living) rows[id] = 0.5 * (first + last);
  return rows[id];
}

std::vector<DrawnHypothesis> HypothesisHistory::drawn(int frames) const {
  const int oldest = std::max(0, now_ - frames);
  const auto isShown = [&](const Branch& branch) { return branch.end >= oldest; };
  std::map<std::uint64_t, std::vector<std::uint64_t>> children;
  std::vector<std::uint64_t> roots;
  for (const auto& [id, branch] : branches_) {
    if (!isShown(branch)) continue;
    const auto parent = branches_.find(branch.parent);
    const bool has_parent = parent != branches_.end() && isShown(parent->second) && parent->first < id;
    has_parent ? children[branch.parent].push_back(id) : roots.push_back(id);
  }
  std::map<std::uint64_t, double> rows;
  double next_row = 0.0;
  for (const std::uint64_t root : roots) place(root, children, next_row, rows);
  const std::set<std::uint64_t> way = wayToLiving();
  const auto position = [&](int frame) {
    return std::clamp(static_cast<double>(frame - oldest) / std::max(1, now_ - oldest), 0.0, 1.0);
  };
  std::vector<DrawnHypothesis> result;
  for (const auto& [id, row] : rows) {
    const Branch& branch = branches_.at(id);
    const auto parent = rows.find(branch.parent);
    const bool is_living = branch.told == now_;
    result.push_back({id, position(branch.born), position(branch.end), row, parent == rows.end() ? row : parent->second,
                      is_living ? branch.weight : 0.0, is_living, !is_living && way.count(id) > 0});
  }
  return result;
}

std::size_t HypothesisHistory::rows(const std::vector<DrawnHypothesis>& drawn) {
  double last = -1.0;
  for (const DrawnHypothesis& hypothesis : drawn) last = std::max(last, hypothesis.row);
  return static_cast<std::size_t>(std::lround(std::floor(last) + 1.0));
}

}  // namespace semantic_mht_slam
