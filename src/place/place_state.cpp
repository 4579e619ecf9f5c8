#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"
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
  archive.require(refusal >= PlaceRefusal::kNone && refusal <= PlaceRefusal::kBetterCandidate,
                  "a refusal that there is not");
  archive.require(isNotNegative(cov) && inliers >= 0, "a match whose covariance is not positive");
}

}  // namespace

void LoopFilter::transfer(StateArchive& archive) {
  archive(loop_prob_);
  archive.require(isProbability(loop_prob_), "probabilities that are none");
}

void PaperChain::transfer(StateArchive& archive) {
  archive(filter_);
}

void PlaceRecognizer::transfer(StateArchive& archive, std::vector<PlacesOfSubmap> submaps) {
  if (archive.isReading()) {
    for (PlacesOfSubmap& submap : submaps) {
      archive.requireGoingOn();
      if (paper_) paper_->add(submap.histogram, submap.keyframes);
      const std::size_t count = places_.size() + submap.keyframes.size();
      add(std::move(submap.keyframes), count);
    }
  }
  bool has_filter = paper_.has_value();
  archive(has_filter);
  if (has_filter != paper_.has_value()) throw InputError("made with another place.chain than the present one");
  if (paper_) archive(*paper_);
  const std::size_t count = archive.count<PlaceMatch>(recent_.size());
  if (archive.isReading()) recent_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (archive.isReading()) recent_.emplace_back();
    PlaceMatch& match = recent_[i];
    transferMatch(archive, match);
    if (match.query >= places_.size() || match.match >= places_.size()) {
      StateArchive::fail("a match of places that are not there");
    }
  }
}

}  // namespace semantic_mht_slam
