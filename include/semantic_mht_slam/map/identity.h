#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "semantic_mht_slam/map/side_by_side.h"

namespace semantic_mht_slam {

class StateArchive;

/// What happened to the identity of landmarks.
struct IdentityEvent {
  enum class Kind {
    kMerged,     ///< two landmarks became one
    kKeptApart,  ///< they do not become, or are no longer, one: a frame shows both side by side
    kSplit,      ///< they are two again: the loop closure that made them one was refused
  };
  Kind kind = Kind::kMerged;
  SubmapId submap;    ///< the newest one then
  ClosureId closure;  ///< that says they are one; none: the duplicate test of a submap
  LandmarkId a = kNoLandmark;
  LandmarkId b = kNoLandmark;

  void transfer(StateArchive& archive);
};

/// Whether a loop closure holds.
struct ClosureDecision {
  ClosureId closure;
  bool holds = false;
  std::string reason = "refused by the pose graph";  ///< if it does not
};

/// Which names mean one landmark. A name is the id that the mapper gave a landmark when it saw it first. Loop closures
/// and duplicate tests say of two names that they mean the same; a landmark is what these sayings join, as long as they
/// hold and no frame shows two of its names side by side. It goes by its oldest name.
///
/// The result depends on the sayings, in the order in which they came, on which closures hold now, and on what was seen
/// side by side so far; not on how it came to be.
class Identity {
 public:
  /// What a submap saw, and which of its names its duplicate test took for one landmark.
  void add(const Submap& submap);

  /// What a loop closure says, or says besides; it does not hold until `decide` says so.
  void add(ClosureId closure, const std::vector<SameLandmark>& pairs);

  /// Loop closures that hold from now on, or fell.
  void decide(const std::vector<ClosureDecision>& decisions);

  /// The landmark that a name means.
  LandmarkId landmarkOf(LandmarkId name) const;

  /// The names of a landmark, rising; itself first.
  std::vector<LandmarkId> namesOf(LandmarkId landmark) const;

  /// The landmarks with other names than at the last call, each as the list of its names; one that was split is there
  /// in its parts. By rising id.
  std::vector<std::vector<LandmarkId>> takeChanges();

  /// The names of these landmarks.
  const std::set<LandmarkId>& changedNames() const { return changed_; }

  /// Every merger and every time that two landmarks were found to be two, in the order in which that happened.
  const std::vector<IdentityEvent>& ledger() const { return ledger_; }

  /// The ledger and what changed; whoever reads calls `restore` afterwards.
  void transfer(StateArchive& archive);

  /// Instead of the calls that led to it: what `submaps` and `closures` (those that were verified, by rising id, each
  /// with the submap that it came after) say, and which of them hold.
  struct Saying {
    SubmapId submap;
    ClosureDecision decision;
    const std::vector<SameLandmark>* pairs = nullptr;
  };
  void restore(const IdVector<SubmapId, std::shared_ptr<const Submap>>& submaps, const std::vector<Saying>& closures);

 private:
  struct Edge {
    SameLandmark names;
    ClosureId closure;
    enum class State { kWaiting, kHolds, kExcluded } state = State::kWaiting;
  };

  void addEdges(ClosureId closure, const std::vector<SameLandmark>& pairs);
  void join(Edge& edge);
  void joinFrom(std::size_t first_edge);
  void joinAgain();
  bool isSplitBy(const Submap& submap) const;
  void log(IdentityEvent::Kind kind, const Edge& edge);

  SideBySide seen_;
  SubmapId newest_;
  std::vector<Edge> edges_;
  std::size_t joined_ = 0;  ///< edges up to here were looked at
  std::set<ClosureId> holding_;
  std::map<LandmarkId, LandmarkId> landmark_of_;            ///< where it differs from the name
  std::map<LandmarkId, std::vector<LandmarkId>> names_of_;  ///< of landmarks with several
  std::set<LandmarkId> changed_;                            ///< names
  std::vector<IdentityEvent> ledger_;
};

}  // namespace semantic_mht_slam
