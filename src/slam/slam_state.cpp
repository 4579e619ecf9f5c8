#include "semantic_mht_slam/slam/slam_state.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/models/detection_state.h"
#include "semantic_mht_slam/slam/drift_prior.h"
#include "semantic_mht_slam/slam/map_delta.h"
#include "semantic_mht_slam/slam/slam.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, InputCounters& counters) {
  auto& [odometry, odometry_invalid, odometry_not_rising, odometry_outliers, frames, frames_before_odometry,
         frames_not_rising, frames_far_ahead, frames_in_odometry_gap, frames_waiting_too_long, detections,
         detections_invalid, detections_at_origin, covariances_unknown, frames_standing] = counters;
  archive(odometry, odometry_invalid, odometry_not_rising, odometry_outliers, frames, frames_before_odometry);
  archive(frames_not_rising);
  archive(frames_far_ahead, frames_in_odometry_gap, frames_waiting_too_long, detections, detections_invalid);
  archive(detections_at_origin, covariances_unknown, frames_standing);
}

void transfer(StateArchive& archive, UncertainPose& pose) {
  auto& [T_world_base, cov, shared] = pose;
  archive(T_world_base, cov, shared);
}

void FrameAssembler::WaitingFrame::transfer(StateArchive& archive) {
  archive(index, stamp, detections);
  archive.requireStamp(stamp);
}

void FrameAssembler::transfer(StateArchive& archive) {
  archive(odometry_, waiting_, next_index_, last_taken_, counters_);
  archive.require(areRising(odometry_, [](const StampedPose& pose) { return pose.stamp; }),
                  "odometry whose stamps do not rise");
  archive.require(areRising(waiting_, [](const WaitingFrame& frame) { return frame.stamp; }),
                  "frames whose stamps do not rise");
  if (last_taken_) archive.requireStamp(*last_taken_);
}

namespace {

/// A vehicle that was localizing goes on from its last fix if that is not far back.
Mode modeAgain(std::size_t kind, bool is_mapping_wanted, const SlamConfig& config, const Sessions& sessions) {
  if (kind == Mode(Mapping{}).index()) return Mapping{};
  Localizer localizer(config.localization);
  const MapFix* fix = sessions.latestFix();
  const std::optional<StampedPose> odometry = sessions.latestOdometry();
  if (fix == nullptr || !odometry) return Localizing{localizer, is_mapping_wanted};
  const double way_m = (odometry->T_world_base.translation_m - fix->T_odom_base.translation_m).norm();
  if (way_m > config.localization.lost_after_m) return Localizing{localizer, is_mapping_wanted};
  const Motion motion = motionOf(fix->T_odom_base.inverse() * odometry->T_world_base);
  OdometryModel model;  // what was learned is read later
  model.noise = config.mapper.odometry.noise;
  const double stddev_m = driftPrior(fix->T_map_base, 0.0, motion, model, config.back_end.revisit).stddev_xy_m;
  localizer.expectAt(fix->T_map_base * fix->T_odom_base.inverse(), stddev_m);
  if (is_mapping_wanted) return Following{localizer};
  return Localizing{localizer, false};
}

void transferMode(StateArchive& archive, const SlamConfig& config, SlamParts& parts) {
  std::size_t kind = parts.mode.index();
  const auto* localizing = std::get_if<Localizing>(&parts.mode);
  bool is_mapping_wanted = localizing == nullptr || localizing->until_found;
  archive(kind, is_mapping_wanted);
  archive.require(kind < std::variant_size_v<Mode>, "a mode that there is not");
  if (archive.isReading()) parts.mode = modeAgain(kind, is_mapping_wanted, config, parts.sessions);
}

void transferDetector(StateArchive& archive, const SlamConfig&, SlamParts& parts) {
  archive(parts.range_factor, parts.is_fitted, parts.detector_range, parts.waiting);
  archive(parts.continuity, parts.unconfirmed, parts.standing);
  if (!(parts.range_factor > 1e-3 && parts.range_factor < 1e3)) StateArchive::fail("a detector of no range");
  archive.require(areRising(parts.waiting, [](const Frame& frame) { return frame.stamp; }),
                  "frames whose stamps do not rise");
}

void transferInput(StateArchive& archive, const SlamConfig& config, SlamParts& parts) {
  std::string method = nameOf(config.method);
  archive(method);
  if (method != nameOf(config.method)) {
    throw InputError("made with the method '" + method + "', the present one is '" + nameOf(config.method) + "'");
  }
  archive(parts.assembler, parts.sessions, parts.latest_frame, parts.rng);
  archive(parts.driven, parts.submap_driven, parts.tied_at_m, parts.prediction);
  archive(parts.latest, parts.start_cov);
  transferMode(archive, config, parts);
}

void transferSubmaps(StateArchive& archive, const SlamConfig&, SlamParts& parts) {
  parts.map.transferSubmaps(archive);
}

void transferKeyframes(StateArchive& archive, const SlamConfig& config, SlamParts& parts) {
  const int classes = parts.closer ? parts.closer->classes().size() : 0;
  parts.map.transferKeyframes(archive, classes, config.back_end.keyframe.sighting_floor_m);
  archive.require(parts.sessions.fits(parts.map), "sessions of other keyframes than there are");
  archive.require(parts.prediction.T_map_keyframe.size() <= parts.map.keyframes().size(),
                  "a prediction from other keyframes than there are");
}

void transferGraph(StateArchive& archive, const SlamConfig&, SlamParts& parts) {
  parts.graph.transfer(archive, parts.map);
  if (parts.closer) parts.closer->transfer(archive, parts.map);
}

void transferMapper(StateArchive& archive, const SlamConfig&, SlamParts& parts) {
  if (!parts.mapper) return;
  archive(*parts.mapper);
  archive.require(parts.mapper->fits(parts.map.submaps().size()),
                  "an open submap that does not follow the finished ones");
  archive.require(parts.map.newestName() < parts.mapper->nextName(), "a name of a landmark that is still to be given");
  if (!archive.isReading()) return;
  parts.odometry = parts.mapper->odometryModel();
  parts.closer->setOdometry(parts.odometry);
}

void transferFixes(StateArchive& archive, const SlamConfig&, SlamParts& parts) {
  parts.fixes.transfer(archive, parts.map);
  parts.graph.transferPositions(archive);
}

/// Without any fix the state has no section of them, as that of a program that knows none.
bool hasFixes(const SlamParts& parts) {
  return parts.fixes.counters().received > 0;
}

/// What is written and read together, in the order in which it is read.
struct Section {
  const char* name;
  int version;
  void (*transfer)(StateArchive& archive, const SlamConfig& config, SlamParts& parts);
  bool (*isNeeded)(const SlamParts& parts) = nullptr;  ///< none: always
};

constexpr Section kSections[] = {
    {"detector", 3, transferDetector},          {"input", 6, transferInput}, {"submaps", 4, transferSubmaps},
    {"keyframes", 5, transferKeyframes},        {"graph", 5, transferGraph}, {"hypotheses", 9, transferMapper},
    {kFixesSection, 1, transferFixes, hasFixes}};

template <class Iterator>
Iterator findSection(Iterator begin, Iterator end, const char* name) {
  return std::find_if(begin, end, [&](const StateSection& section) { return section.name == name; });
}

/// The lengths follow the detector that the state was made with: `fitted` is `config` with these. The bytes of a
/// section go when it has been read.
void restore(SlamState& state, const KeepReading& keep_reading, const SlamConfig& config, const ClassTable& classes,
             SlamConfig& fitted, SlamParts& parts) {
  const std::string problem = whyUnreadable(state);
  if (!problem.empty()) throw InputError(problem);
  std::size_t memory = state.most_memory;
  for (const Section& section : kSections) {
    const auto found = findSection(state.sections.begin(), state.sections.end(), section.name);
    if (found == state.sections.end()) continue;
    try {
      StateArchive archive(found->bytes, keep_reading, classes.size(), memory);
      section.transfer(archive, fitted, parts);
      archive.requireEnd();
      memory = archive.memoryLeft();
      std::string().swap(found->bytes);
    } catch (const std::exception& error) {
      throw InputError(std::string("section '") + section.name + "': " + error.what());
    }
    if (section.transfer != transferDetector || parts.range_factor == 1.0) continue;
    fitted = fittedTo(config, parts.range_factor);
    fitParts(fitted, classes, parts);
  }
}

}  // namespace

std::string whyUnreadable(const SlamState& state) {
  for (const Section& section : kSections) {
    const auto found = findSection(state.sections.begin(), state.sections.end(), section.name);
    const std::string name = std::string("the section '") + section.name + "'";
    if (found == state.sections.end() && section.isNeeded != nullptr) continue;
    if (found == state.sections.end()) return name + " is missing";
    if (found->version != section.version) {
      return name + " has version " + std::to_string(found->version) + ", this program reads version " +
             std::to_string(section.version);
    }
  }
  return "";
}

SlamState stateOf(const SlamConfig& fitted, const SlamParts& parts) {
  SlamState state;
  for (const Section& section : kSections) {
    if (section.isNeeded != nullptr && !section.isNeeded(parts)) continue;
    StateArchive archive;
    section.transfer(archive, fitted, const_cast<SlamParts&>(parts));  // a writing archive changes nothing
    state.sections.push_back({section.name, section.version, archive.written()});
  }
  state.content = contentOf(parts);
  return state;
}

SlamState Slam::snapshot() const {
  return stateOf(fitted_, parts_);
}

Slam::Slam(const SlamConfig& config, const ClassTable& classes, SlamState state, const KeepReading& keep_reading)
    : Slam(config, classes) {
  try {
    restore(state, keep_reading, config_, classes_, fitted_, parts_);
  } catch (const std::exception& error) {
    if (state.source.empty()) throw;
    throw InputError(state.source + ": " + error.what());
  }
}

}  // namespace semantic_mht_slam
