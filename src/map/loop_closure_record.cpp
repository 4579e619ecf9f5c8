#include "semantic_mht_slam/map/loop_closure_record.h"

namespace semantic_mht_slam {

std::string nameOf(ClosureSource source) {
  if (source == ClosureSource::kPlace) return "place";
  return source == ClosureSource::kHypotheses ? "hypotheses" : "revisit";
}

}  // namespace semantic_mht_slam
