#include "semantic_mht_slam/place/place_match.h"

#include <stdexcept>

namespace semantic_mht_slam {

std::string reasonText(PlaceRefusal refusal) {
  switch (refusal) {
    case PlaceRefusal::kNone:
      return "";
    case PlaceRefusal::kUnlikePlace:
      return "the scenes are not alike";
    case PlaceRefusal::kUnlikeTopology:
      return "topology score too low";
    case PlaceRefusal::kUnlikeScene:
      return "sum of topology and scene score too low";
    case PlaceRefusal::kFilter:
      return "loop filter is not convinced";
    case PlaceRefusal::kNoAlignment:
      return "no motion lays the scenes onto each other";
    case PlaceRefusal::kFewInliers:
      return "too few objects lie on each other";
    case PlaceRefusal::kFewClasses:
      return "objects of too few classes lie on each other";
    case PlaceRefusal::kOnALine:
      return "the objects stand in one row";
    case PlaceRefusal::kUncertain:
      return "the pose stays too uncertain";
    case PlaceRefusal::kLowScore:
      return "too little of the scenes lies on each other";
    case PlaceRefusal::kAmbiguous:
      return "another alignment is nearly as good";
    case PlaceRefusal::kOutsideGate:
      return "further from the estimate than drift explains";
    case PlaceRefusal::kRivalPlace:
      return "another place fits nearly as well";
    case PlaceRefusal::kUnsupported:
      return "no neighbouring keyframe agrees";
    case PlaceRefusal::kBetterCandidate:
      return "another keyframe of the place fits better";
  }
  throw std::logic_error("reasonText: no such refusal");
}

}  // namespace semantic_mht_slam
