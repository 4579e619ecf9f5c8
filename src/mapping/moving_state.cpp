#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/mapping/mapper.h"
#include "semantic_mht_slam/mapping/moving_objects.h"

// What of the moving objects outlives a program.
namespace semantic_mht_slam {
namespace {

constexpr double kMostKeptLogOdds = 100.0;

}  // namespace

void MovingObjects::Track::transfer(StateArchive& archive) {
  archive(id, class_index, stamp, driven_m, missed, sightings, wander_variance_per_m);
  archive(place_m, place_cov_m2, motion, motion_cov, log_odds);
  archive.requireClass(class_index);
  archive.requireStamp(stamp);
  archive.require(missed >= 0 && sightings > 0 && wander_variance_per_m >= 0.0 &&
                      std::abs(log_odds) <= kMostKeptLogOdds && isPositive(place_cov_m2) && isPositive(motion_cov),
                  "a track of nothing");
}

void MovingObjects::Rate::transfer(StateArchive& archive) {
  archive(moving, all);
  archive.require(moving >= 0.0 && moving <= all, "more that moves than there is");
}

void MovingObjects::transfer(StateArchive& archive) {
  const std::size_t classes = rate_of_class_.size();
  archive(rate_of_class_);
  if (rate_of_class_.size() != classes) StateArchive::fail("it belongs to another class table");
  archive(tracks_, known_prob_, next_id_);
  for (const auto& [track, prob] : known_prob_) {
    archive.require(track < next_id_ && isProbability(prob), "a track of nothing");
  }
  archive.require(std::all_of(tracks_.begin(), tracks_.end(),
                              [this](const Track& track) { return known_prob_.count(track.id) > 0; }),
                  "a track that is not known");
}

void MovingCounts::transfer(StateArchive& archive) {
  archive(flagged, found);
}

void LandmarkSpan::transfer(StateArchive& archive) {
  archive(submap, first, last, sightings, moving);
  archive.requireStamp(first);
  archive.requireStamp(last);
  archive.require(first <= last && sightings > 0 && moving >= 0.0 && moving <= sightings + kRounding,
                  "a landmark that was seen before it was seen first");
}

}  // namespace semantic_mht_slam
