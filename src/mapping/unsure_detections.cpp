#include "semantic_mht_slam/mapping/unsure_detections.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace semantic_mht_slam {
namespace {

bool isLessSure(const UnsureDetection& a, const UnsureDetection& b) {
  return std::tie(a.probability, a.frame, a.row) < std::tie(b.probability, b.frame, b.row);
}

bool comesBefore(const UnsureDetection& a, const UnsureDetection& b) {
  return std::tie(a.frame, a.row) < std::tie(b.frame, b.row);
}

}  // namespace

bool UnsureSelection::isPicked(double probability) const {
  if (result_.items.size() < limits_.most) return true;
  return limits_.most > 0 && probability < result_.items.front().probability;
}

void UnsureSelection::add(UnsureDetection detection) {
  std::vector<UnsureDetection>& items = result_.items;
  if (items.size() == limits_.most) {
    std::pop_heap(items.begin(), items.end(), isLessSure);
    items.pop_back();
  }
  items.push_back(std::move(detection));
  std::push_heap(items.begin(), items.end(), isLessSure);
}

UnsureDetections UnsureSelection::take(SubmapId submap) {
  result_.submap = submap;
  result_.below_prob = limits_.below_prob;
  std::sort(result_.items.begin(), result_.items.end(), comesBefore);
  return std::exchange(result_, {});
}

}  // namespace semantic_mht_slam
