#include "semantic_mht_slam/merging/map_merger.h"

namespace semantic_mht_slam {

const ComparedPair* PairMemory::find(const std::string& a, const std::string& b) const {
  const auto found = pairs_.find({a, b});
  return found == pairs_.end() ? nullptr : &found->second;
}

const ComparedPair& PairMemory::keep(const std::string& a, const std::string& b, ComparedPair pair) {
  return pairs_[{a, b}] = std::move(pair);
}

void PairMemory::forget(const std::string& name) {
  for (auto entry = pairs_.begin(); entry != pairs_.end();) {
    const auto& [a, b] = entry->first;
    entry = a == name || b == name ? pairs_.erase(entry) : std::next(entry);
  }
}

void PairMemory::expect(double range_factor) {
  if (range_factor != range_factor_) pairs_.clear();
  range_factor_ = range_factor;
}

}  // namespace semantic_mht_slam
