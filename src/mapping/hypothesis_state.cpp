#include "semantic_mht_slam/mapping/hypothesis_state.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "semantic_mht_slam/common/log_math.h"
#include "semantic_mht_slam/common/state_checks.h"

namespace semantic_mht_slam {
namespace {

/// Values that several holders share, each with a number.
template <class Value>
class SharedValues {
 public:
  using Pointer = std::shared_ptr<const Value>;

  bool isNew(const Pointer& pointer) const { return pointer != nullptr && number_of_.count(pointer.get()) == 0; }

  void add(Pointer pointer) {
    number_of_.emplace(pointer.get(), values_.size());
    values_.push_back(std::move(pointer));
  }

  const std::vector<Pointer>& values() const { return values_; }

  /// A pointer as the number of its value; 0 is null.
  void transferPointer(StateArchive& archive, Pointer& pointer) const {
    std::size_t number = pointer ? number_of_.at(pointer.get()) + 1 : 0;
    archive(number);
    if (number > values_.size()) StateArchive::fail("a number names nothing");
    if (archive.isReading()) pointer = number == 0 ? nullptr : values_[number - 1];
  }

 private:
  std::vector<Pointer> values_;
  std::map<const Value*, std::size_t> number_of_;
};

using Landmarks = SharedValues<TrackedLandmark>;
using Histories = SharedValues<AssociationRecord>;

void transferValues(StateArchive& archive, Landmarks& landmarks) {
  const std::size_t count = archive.count<TrackedLandmark>(landmarks.values().size());
  for (std::size_t i = 0; i < count; ++i) {
    TrackedLandmark landmark;
    if (!archive.isReading()) landmark = *landmarks.values()[i];
    archive(landmark);
    if (archive.isReading()) landmarks.add(std::make_shared<const TrackedLandmark>(std::move(landmark)));
  }
}

/// Adds the records of a history, the oldest first.
void addHistory(const Histories::Pointer& newest, Histories& histories) {
  std::vector<Histories::Pointer> records;
  for (Histories::Pointer record = newest; histories.isNew(record); record = record->previous) {
    records.push_back(record);
  }
  std::for_each(records.rbegin(), records.rend(), [&](const auto& record) { histories.add(record); });
}

void transferValues(StateArchive& archive, Histories& histories) {
  const std::size_t count = archive.count<AssociationRecord>(histories.values().size());
  for (std::size_t i = 0; i < count; ++i) {
    AssociationRecord record;
    if (!archive.isReading()) record = *histories.values()[i];
    auto& [previous, frame, landmark_of_measurement, offset] = record;
    histories.transferPointer(archive, previous);
    archive(frame, landmark_of_measurement, offset);
    if (archive.isReading()) histories.add(std::make_shared<const AssociationRecord>(std::move(record)));
  }
}

void transferLeaf(StateArchive& archive, const Landmarks& shared_landmarks, const Histories& histories,
                  MapHypothesis& leaf) {
  auto& [id, parent_id, born_frame, log_weight, landmarks, history, false_positives, offset, map_offset, expected_found,
         expected_missed] = leaf;
  archive(id, parent_id, born_frame, log_weight, false_positives, offset, map_offset, expected_found, expected_missed);
  histories.transferPointer(archive, history);
  archive.require(log_weight <= kRounding && false_positives >= 0 && expected_found >= 0 && expected_missed >= 0.0,
                  "a hypothesis of a weight above one, or a negative count");
  const std::size_t count = archive.count<HypothesisLandmark>(landmarks.size());
  if (archive.isReading()) landmarks.clear();
  makeRoom(landmarks, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (archive.isReading()) landmarks.emplace_back();
    HypothesisLandmark& landmark = landmarks[i];
    shared_landmarks.transferPointer(archive, landmark.tracked);
    archive(landmark.existence);
    if (!landmark.tracked) StateArchive::fail("a hypothesis lacks a landmark");
    archive.require(i == 0 || landmarks[i - 1]->id < landmark->id, "landmarks whose ids do not rise");
  }
}

}  // namespace

void transfer(StateArchive& archive, PoseOffset& offset) {
  auto& [mean, cov] = offset;
  archive(mean, cov);
  archive.require(isNotNegative(cov), "an offset whose covariance is not positive");
}

void transfer(StateArchive& archive, Existence& existence) {
  auto& [log_odds, visible_prob, miss_likelihood] = existence;
  archive(log_odds, visible_prob, miss_likelihood);
  archive.require(isProbability(visible_prob) && miss_likelihood >= 0.0, "probabilities that are none");
}

void transfer(StateArchive& archive, TrackedLandmark& landmark) {
  auto& [id, position, class_probs, observations, is_from_earlier_submap, first_submap, last_submap, updated_at_m,
         earlier, is_expected] = landmark;
  archive(id, position, class_probs, observations, is_from_earlier_submap);
  archive(first_submap, last_submap, updated_at_m, earlier, is_expected);
  archive.requireName(id);
  archive.requireClassCount(class_probs.size());
  archive.require(areProbabilities(class_probs) && observations >= 0, "probabilities that are none");
}

void transferLeaves(StateArchive& archive, std::vector<MapHypothesis>& leaves) {
  Landmarks landmarks;
  Histories histories;
  if (!archive.isReading()) {
    for (const MapHypothesis& leaf : leaves) {
      for (const HypothesisLandmark& landmark : leaf.landmarks) {
        if (landmarks.isNew(landmark.tracked)) landmarks.add(landmark.tracked);
      }
      addHistory(leaf.history, histories);
    }
  }
  transferValues(archive, landmarks);
  transferValues(archive, histories);
  const std::size_t count = archive.count<MapHypothesis>(leaves.size());
  if (count == 0) StateArchive::fail("a tree without leaves");
  if (archive.isReading()) leaves.clear();
  std::vector<double> log_weights;
  for (std::size_t i = 0; i < count; ++i) {
    if (archive.isReading()) leaves.emplace_back();
    transferLeaf(archive, landmarks, histories, leaves[i]);
    log_weights.push_back(leaves[i].log_weight);
  }
  archive.require(std::abs(logSumExp(log_weights)) < kRounding, "hypotheses whose weights do not add up to one");
}

}  // namespace semantic_mht_slam
