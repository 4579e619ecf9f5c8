#include "semantic_mht_slam/slam/slam_state.h"

#include <algorithm>
#include <exception>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/map_state.h"
#include "semantic_mht_slam/models/detection_state.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, Frame& frame) {
  auto& [index, stamp, T_odom_base, detections] = frame;
  archive(index, stamp, T_odom_base, detections);
}

void transfer(StateArchive& archive, InputCounters& counters) {
  auto& [odometry, odometry_invalid, odometry_not_rising, frames, frames_before_odometry, frames_not_rising,
         frames_far_ahead, frames_in_odometry_gap, frames_waiting_too_long, detections, detections_invalid] = counters;
  archive(odometry, odometry_invalid, odometry_not_rising, frames, frames_before_odometry, frames_not_rising);
  archive(frames_far_ahead, frames_in_odometry_gap, frames_waiting_too_long, detections, detections_invalid);
}

void transfer(StateArchive& archive, SubmapPrediction& prediction) {
  auto& [prior, T_map_keyframe, driven_m] = prediction;
  auto& [T_a_b, stddev_xy_m, stddev_z_m, stddev_yaw_rad] = prior;
  archive(T_a_b, stddev_xy_m, stddev_z_m, stddev_yaw_rad, T_map_keyframe, driven_m);
}

void transfer(StateArchive& archive, MapFix& fix) {
  auto& [stamp, T_odom_base, T_map_base] = fix;
  archive(stamp, T_odom_base, T_map_base);
}

void Slam::Session::transfer(StateArchive& archive) {
  archive(first_odometry, first_keyframe, fixes);
}

void FrameAssembler::WaitingFrame::transfer(StateArchive& archive) {
  archive(index, stamp, detections);
}

void FrameAssembler::transfer(StateArchive& archive) {
  archive(odometry_, waiting_, next_index_, last_frame_, counters_);
}

const std::vector<Slam::Section>& Slam::sections() {
  static const std::vector<Section> kSections = {{"input", 1, &Slam::transferInput},
                                                 {"submaps", 1, &Slam::transferSubmaps},
                                                 {"keyframes", 1, &Slam::transferKeyframes},
                                                 {"graph", 1, &Slam::transferGraph},
                                                 {"hypotheses", 3, &Slam::transferMapper}};
  return kSections;
}

void Slam::transferInput(StateArchive& archive) {
  std::string method = nameOf(method_);
  archive(method);
  if (method != nameOf(method_)) {
    throw InputError("made with the method '" + method + "', the present one is '" + nameOf(method_) + "'");
  }
  archive(assembler_, odometry_, latest_frame_, rng_, submap_frames_, driven_m_, submap_driven_m_);
  archive(prediction_, next_prediction_, sessions_, is_mapping_wanted_);
  bool is_localizing = localizer_.has_value();
  archive(is_localizing);
  if (archive.isReading() && is_localizing) localizer_.emplace(localizer_config_);
  if (sessions_.empty() || sessions_.back().first_odometry > odometry_.size())
    StateArchive::fail("sessions of no odometry");
}

void Slam::transferSubmaps(StateArchive& archive) {
  archive(map_);
}

void Slam::transferKeyframes(StateArchive& archive) {
  if (back_end_) back_end_->transferKeyframes(archive, map_);
}

void Slam::transferGraph(StateArchive& archive) {
  if (back_end_) back_end_->transferGraph(archive, map_);
}

void Slam::transferMapper(StateArchive& archive) {
  if (mapper_) archive(*mapper_);
}

SlamState Slam::snapshot() const {
  SlamState state;
  for (const Section& section : sections()) {
    StateArchive archive;
    (const_cast<Slam*>(this)->*section.transfer)(archive);  // a writing archive changes nothing
    state.sections.push_back({section.name, section.version, archive.written()});
  }
  return state;
}

Slam::Slam(const SlamConfig& config, const ClassTable& classes, const SlamState& state, const KeepReading& keep_reading)
    : Slam(config, classes) {
  try {
    restore(state, keep_reading);
  } catch (const std::exception& error) {
    if (state.source.empty()) throw;
    throw InputError(state.source + ": " + error.what());
  }
}

void Slam::restore(const SlamState& state, const KeepReading& keep_reading) {
  for (const Section& section : sections()) {
    const auto found = std::find_if(state.sections.begin(), state.sections.end(),
                                    [&](const StateSection& other) { return other.name == section.name; });
    if (found == state.sections.end()) throw InputError(std::string("the section '") + section.name + "' is missing");
    if (found->version != section.version) {
      throw InputError(std::string("the section '") + section.name + "' has version " + std::to_string(found->version) +
                       ", this program reads version " + std::to_string(section.version));
    }
    StateArchive archive(found->bytes, keep_reading);
    (this->*section.transfer)(archive);
    archive.requireEnd();
  }
  if (localizer_) localizeNearLastFix();
}

void Slam::localizeNearLastFix() {
  const std::vector<MapFix>& fixes = sessions_.back().fixes;
  const std::optional<StampedPose> odometry = latestOdometry();
  if (fixes.empty() || !odometry) return;
  const MapFix& fix = fixes.back();
  const double way_m = (odometry->T_world_base.translation_m - fix.T_odom_base.translation_m).norm();
  if (way_m > localizer_config_.lost_after_m) return;
  const RevisitConfig noise;
  localizer_->expectAt(fix.T_map_base * fix.T_odom_base.inverse(), noise.base_stddev_m + noise.drift_per_m * way_m);
  is_following_ = is_mapping_wanted_;
}

}  // namespace semantic_mht_slam
