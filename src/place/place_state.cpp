#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/place/place_recognizer.h"

namespace semantic_mht_slam {
namespace {

void transferMatch(StateArchive& archive, PlaceMatch& match) {
  auto& [query, index, accepted, refusal, T_match_query, cov, inliers, static_inliers, histogram_divergence,
         descriptor_score, topology_score, scene_score, loop_prob, verification_score, rival_score, log_evidence,
         pairs] = match;
  archive(query, index, accepted, refusal, T_match_query, cov, inliers, static_inliers, histogram_divergence);
  archive(descriptor_score, topology_score, scene_score, loop_prob, verification_score, rival_score, log_evidence);
  archive(pairs);
}

}  // namespace

void PlaceRecognizer::transfer(StateArchive& archive, std::vector<Keyframe> keyframes) {
  if (archive.isReading()) {
    const std::size_t count = keyframes.size();
    places_.clear();
    add(std::move(keyframes), count);
  }
  recent_.resize(archive.count(recent_.size()));
  for (PlaceMatch& match : recent_) {
    transferMatch(archive, match);
    if (match.query >= places_.size() || match.match >= places_.size()) {
      StateArchive::fail("a match of places that are not there");
    }
  }
}

}  // namespace semantic_mht_slam
