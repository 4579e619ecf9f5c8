#include "semantic_mht_slam/map/identity.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {

void IdentityEvent::transfer(StateArchive& archive) {
  archive(kind, submap, closure, a, b);
  if (kind < Kind::kMerged || kind > Kind::kSplit) StateArchive::fail("an event of no known kind");
}

void Identity::add(const Submap& submap) {
  newest_ = submap.id;
  seen_.add(submap.associations, submap.near);
  if (isSplitBy(submap)) joinAgain();
  const std::size_t first = edges_.size();
  addEdges(ClosureId(), submap.duplicates);
  joinFrom(first);
}

void Identity::add(ClosureId closure, const std::vector<SameLandmark>& pairs) {
  const std::size_t first = edges_.size();
  addEdges(closure, pairs);
  if (holding_.count(closure) > 0) joinFrom(first);
}

void Identity::addEdges(ClosureId closure, const std::vector<SameLandmark>& pairs) {
  for (const SameLandmark& names : pairs) edges_.push_back({names, closure});
}

void Identity::decide(const std::vector<ClosureDecision>& decisions) {
  std::set<ClosureId> now = holding_;
  for (const ClosureDecision& decision : decisions) {
    if (decision.holds) now.insert(decision.closure);
    if (!decision.holds) now.erase(decision.closure);
  }
  if (now == holding_) return;
  const auto is_new = [&](const Edge& edge) {
    return holding_.count(edge.closure) == 0 && now.count(edge.closure) > 0;
  };
  const bool are_all_new = std::includes(now.begin(), now.end(), holding_.begin(), holding_.end()) &&
                           std::none_of(edges_.begin(), edges_.begin() + joined_, is_new);
  holding_ = std::move(now);
  are_all_new ? joinFrom(joined_) : joinAgain();
}

LandmarkId Identity::landmarkOf(LandmarkId name) const {
  const auto found = landmark_of_.find(name);
  return found == landmark_of_.end() ? name : found->second;
}

std::vector<LandmarkId> Identity::namesOf(LandmarkId landmark) const {
  const auto found = names_of_.find(landmark);
  return found == names_of_.end() ? std::vector<LandmarkId>{landmark} : found->second;
}

/// Lets an edge that holds act.
void Identity::join(Edge& edge) {
  const LandmarkId a = landmarkOf(edge.names.first);
  const LandmarkId b = landmarkOf(edge.names.second);
  edge.state = Edge::State::kHolds;
  if (a == b) return;
  if (seen_.excludes(namesOf(a), namesOf(b))) {
    edge.state = Edge::State::kExcluded;
    return;
  }
  const std::vector<LandmarkId> names = namesOf(a);
  const std::vector<LandmarkId> others = namesOf(b);
  std::vector<LandmarkId> all;
  std::merge(names.begin(), names.end(), others.begin(), others.end(), std::back_inserter(all));
  names_of_.erase(std::max(a, b));
  for (const LandmarkId name : all) landmark_of_[name] = all.front();
  names_of_[all.front()] = std::move(all);
}

void Identity::joinFrom(std::size_t first_edge) {
  for (std::size_t i = first_edge; i < edges_.size(); ++i) {
    Edge& edge = edges_[i];
    if (!edge.closure.isNone() && holding_.count(edge.closure) == 0) continue;
    const bool were_one = landmarkOf(edge.names.first) == landmarkOf(edge.names.second);
    join(edge);
    joined_ = i + 1;
    if (edge.state == Edge::State::kExcluded) log(IdentityEvent::Kind::kKeptApart, edge);
    if (were_one || edge.state == Edge::State::kExcluded) continue;
    log(IdentityEvent::Kind::kMerged, edge);
    const std::vector<LandmarkId> names = namesOf(landmarkOf(edge.names.first));
    changed_.insert(names.begin(), names.end());
  }
}

/// Lets all edges act that hold now, in their order, as if for the first time.
void Identity::joinAgain() {
  const auto landmark_before = std::exchange(landmark_of_, {});
  const auto names_before = std::exchange(names_of_, {});
  const auto before = [&](LandmarkId name) {
    const auto found = landmark_before.find(name);
    return found == landmark_before.end() ? name : found->second;
  };
  std::vector<Edge::State> states;
  joined_ = 0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    Edge& edge = edges_[i];
    states.push_back(std::exchange(edge.state, Edge::State::kWaiting));
    if (!edge.closure.isNone() && holding_.count(edge.closure) == 0) continue;
    join(edge);
    joined_ = i + 1;
  }
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    const auto& [a, b] = edge.names;
    const bool were_one = before(a) == before(b);
    const bool are_one = landmarkOf(a) == landmarkOf(b);
    if (edge.state == Edge::State::kExcluded && states[i] != edge.state) log(IdentityEvent::Kind::kKeptApart, edge);
    if (edge.state == Edge::State::kWaiting && were_one && !are_one) log(IdentityEvent::Kind::kSplit, edge);
    if (edge.state == Edge::State::kHolds && !were_one) log(IdentityEvent::Kind::kMerged, edge);
  }
  const auto note = [this](const auto& names_of, const auto& others_of) {
    for (const auto& [landmark, names] : names_of) {
      const auto same = others_of.find(landmark);
      if (same == others_of.end() || same->second != names) changed_.insert(names.begin(), names.end());
    }
  };
  note(names_before, names_of_);
  note(names_of_, names_before);
}

/// Whether a frame of the submap shows two names of one landmark side by side.
bool Identity::isSplitBy(const Submap& submap) const {
  std::size_t frame = 0;
  std::map<LandmarkId, std::vector<LandmarkId>> shown;  // names by landmark
  for (const DetectionAssociation& association : submap.associations) {
    if (association.frame != frame) shown.clear();
    frame = association.frame;
    if (association.landmark == kNoLandmark) continue;
    std::vector<LandmarkId>& names = shown[landmarkOf(association.landmark)];
    for (const LandmarkId name : names) {
      if (name != association.landmark && seen_.excludes(name, association.landmark)) return true;
    }
    names.push_back(association.landmark);
  }
  return false;
}

void Identity::log(IdentityEvent::Kind kind, const Edge& edge) {
  ledger_.push_back({kind, newest_, edge.closure, edge.names.first, edge.names.second});
}

std::vector<std::vector<LandmarkId>> Identity::takeChanges() {
  std::set<LandmarkId> landmarks;
  for (const LandmarkId name : changed_) landmarks.insert(landmarkOf(name));
  changed_.clear();
  std::vector<std::vector<LandmarkId>> changes;
  for (const LandmarkId landmark : landmarks) changes.push_back(namesOf(landmark));
  return changes;
}

void Identity::transfer(StateArchive& archive) {
  archive(ledger_, changed_);
}

void Identity::restore(const IdVector<SubmapId, std::shared_ptr<const Submap>>& submaps,
                       const std::vector<Saying>& closures) {
  const std::vector<IdentityEvent> ledger = std::move(ledger_);
  const std::set<LandmarkId> changed = std::move(changed_);
  *this = Identity();
  auto closure = closures.begin();
  for (const SubmapId id : submaps.ids()) {
    const Submap& submap = *submaps[id];
    newest_ = id;
    seen_.add(submap.associations, submap.near);
    addEdges(ClosureId(), submap.duplicates);
    for (; closure != closures.end() && closure->submap == id; ++closure) {
      addEdges(closure->decision.closure, *closure->pairs);
      if (closure->decision.holds) holding_.insert(closure->decision.closure);
    }
  }
  joinAgain();
  changed_ = changed;
  ledger_ = ledger;
}

}  // namespace semantic_mht_slam
