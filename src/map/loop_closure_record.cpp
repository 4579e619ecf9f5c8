#include "semantic_mht_slam/map/loop_closure_record.h"

namespace semantic_mht_slam {

std::string nameOf(ClosureSource source) {
  if (source == ClosureSource::kPlace) return "place";
  if (source == ClosureSource::kHypotheses) return "hypotheses";
  return source == ClosureSource::kRevisit ? "revisit" : "request";
}

}  // namespace semantic_mht_slam
