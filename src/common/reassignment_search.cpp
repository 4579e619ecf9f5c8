#include "semantic_mht_slam/common/reassignment_search.h"

#include <algorithm>
#include <utility>

namespace semantic_mht_slam {

void ReassignmentSearch::start(const SparseCostMatrix& costs) {
  costs_ = &costs;
  allowed_costs_ = costs.costs();
  if (static_cast<int>(holder_.size()) < costs.columns()) holder_.resize(costs.columns(), kUnheld);
  if (static_cast<int>(labels_.size()) < costs.rows()) labels_.resize(costs.rows());
}

void ReassignmentSearch::load(const int* column_for_row, int row_count, const FreeRow* free_rows, int free_row_count) {
  for (int row = 0; row < row_count; ++row) holder_[column_for_row[row]] = kFixed;
  for (int i = 0; i < free_row_count; ++i) holder_[column_for_row[free_rows[i].row]] = i;
}

void ReassignmentSearch::unload(const int* column_for_row, int row_count) {
  for (int row = 0; row < row_count; ++row) holder_[column_for_row[row]] = kUnheld;
}

std::optional<double> ReassignmentSearch::moveLastRow(FreeRow* free_rows, int free_row_count) {
  const int target = free_row_count - 1;
  resetLabels(free_row_count);
  scan(free_rows, target, target, 0.0);
  while (scanNearest(free_rows, free_row_count)) {
  }
  if (labels_[target].previous == kNone) return std::nullopt;
  updateDuals(free_rows, free_row_count);
  return applyCycle(free_rows, target);
}

void ReassignmentSearch::resetLabels(int free_row_count) {
  std::fill_n(labels_.begin(), free_row_count, Label{});
  open_.clear();
  hub_ = Label{};
  hub_open_ = false;
}

// Relaxes the edges from a free row. Paths that are no shorter than the best cycle so far are dropped. Rounding may
// make a reduced cost negative, which must not lead back to vertices that are final: hence the max.
void ReassignmentSearch::scan(const FreeRow* free_rows, int index, int target, double distance) {
  const FreeRow& from = free_rows[index];
  const double row_dual = costs_->cost(from.entry) - from.column_dual;
  Label& end = labels_[target];
  for (int entry = costs_->rowBegin(from.row); entry < costs_->rowEnd(from.row); ++entry) {
    const int holder = holder_[costs_->column(entry)];
    if (holder == kFixed) continue;
    const double free_step = allowed_costs_[entry] - row_dual;
    if (holder == kUnheld) {
      const double candidate = distance + std::max(0.0, free_step);
      if (candidate >= hub_.distance || candidate >= end.distance) continue;
      hub_ = {candidate, index, entry};
      hub_open_ = true;
      const double closed = candidate - free_rows[target].column_dual;
      if (closed < end.distance) end = {closed, kHub, kNone};
    } else {
      const double candidate = distance + std::max(0.0, free_step - free_rows[holder].column_dual);
      Label& label = labels_[holder];
      if (candidate >= label.distance || candidate >= end.distance) continue;
      if (label.previous == kNone && holder != target) open_.push_back(holder);
      label = {candidate, index, entry};
    }
  }
}

void ReassignmentSearch::scanHub(const FreeRow* free_rows, int free_row_count) {
  hub_open_ = false;
  const int target = free_row_count - 1;
  for (int i = 0; i < target; ++i) {
    const double candidate = hub_.distance - free_rows[i].column_dual;
    if (candidate >= labels_[i].distance || candidate >= labels_[target].distance) continue;
    if (labels_[i].previous == kNone) open_.push_back(i);
    labels_[i] = {candidate, kHub, kNone};
  }
}

// Scans the vertex next in distance; false when none is nearer than the end of the cycle.
bool ReassignmentSearch::scanNearest(const FreeRow* free_rows, int free_row_count) {
  const int target = free_row_count - 1;
  double nearest_distance = labels_[target].distance;
  int nearest = kNone;
  for (int i = 0; i < static_cast<int>(open_.size()); ++i) {
    const double distance = labels_[open_[i]].distance;
    if (distance >= nearest_distance) continue;
    nearest_distance = distance;
    nearest = i;
  }
  if (hub_open_ && hub_.distance < nearest_distance) {
    scanHub(free_rows, free_row_count);
    return true;
  }
  if (nearest == kNone) return false;
  const int index = open_[nearest];
  open_[nearest] = open_.back();
  open_.pop_back();
  scan(free_rows, index, target, nearest_distance);
  return true;
}

// Potentials grow by the distance, at most by the length of the cycle; the hub, whose dual is zero, is the reference.
void ReassignmentSearch::updateDuals(FreeRow* free_rows, int free_row_count) const {
  const double length = labels_[free_row_count - 1].distance;
  const double hub_distance = std::min(hub_.distance, length);
  for (int i = 0; i < free_row_count; ++i) {
    const double change = std::min(labels_[i].distance, length) - hub_distance;
    free_rows[i].column_dual = std::min(0.0, free_rows[i].column_dual + change);
  }
}

// Walks the cycle against its direction. Each row takes the column of its successor, together with its dual.
double ReassignmentSearch::applyCycle(FreeRow* free_rows, int target) {
  double extra_cost = 0.0;
  int index = target;
  int released_entry = free_rows[target].entry;
  double released_dual = free_rows[target].column_dual;
  do {
    int entry = labels_[index].entry;
    double dual = released_dual;
    int previous = labels_[index].previous;
    if (previous == kHub) {
      holder_[costs_->column(released_entry)] = kUnheld;
      entry = hub_.entry;
      dual = 0.0;
      previous = hub_.previous;
    }
    FreeRow& row = free_rows[previous];
    released_entry = std::exchange(row.entry, entry);
    released_dual = std::exchange(row.column_dual, dual);
    holder_[costs_->column(entry)] = previous;
    extra_cost += costs_->cost(entry) - costs_->cost(released_entry);
    index = previous;
  } while (index != target);
  return extra_cost;
}

void ReassignmentSearch::storeColumns(const FreeRow* free_rows, int free_row_count, int* column_for_row) const {
  for (int i = 0; i < free_row_count; ++i) column_for_row[free_rows[i].row] = costs_->column(free_rows[i].entry);
}

void ReassignmentSearch::computeBounds(FreeRow* free_rows, int free_row_count) {
  way_in_.resize(free_row_count);
  for (int i = 0; i < free_row_count; ++i) way_in_[i] = -free_rows[i].column_dual;  // from the hub
  for (int i = 0; i < free_row_count; ++i) {
    FreeRow& from = free_rows[i];
    const double row_dual = costs_->cost(from.entry) - from.column_dual;
    double way_out = kForbidden;
    for (int entry = costs_->rowBegin(from.row); entry < costs_->rowEnd(from.row); ++entry) {
      const int holder = holder_[costs_->column(entry)];
      if (holder == kFixed || holder == i) continue;
      const double dual = holder == kUnheld ? 0.0 : free_rows[holder].column_dual;
      const double step = std::max(0.0, allowed_costs_[entry] - row_dual - dual);
      way_out = std::min(way_out, step);
      if (holder != kUnheld) way_in_[holder] = std::min(way_in_[holder], step);
    }
    from.bound = way_out;
  }
  for (int i = 0; i < free_row_count; ++i) free_rows[i].bound += way_in_[i];
}

}  // namespace semantic_mht_slam
