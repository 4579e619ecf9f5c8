#include "semantic_mht_slam/app/result_files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "semantic_mht_slam/app/landmark_files.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "gnss_report.h"

namespace semantic_mht_slam {
namespace {

using Json = nlohmann::ordered_json;

Pose inOutputFrame(const Recording& recording, const Pose& T_map_base) {
  return recording.T_base_cam0 ? toCamera(T_map_base, recording.T_base_cam0->inverse()) : T_map_base;
}

/// Element of a sorted list below which the fraction `quantile` of it lies (nearest rank).
double quantileOf(const std::vector<double>& sorted, double quantile) {
  const double rank = std::ceil(quantile * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double meanOf(std::vector<double>::const_iterator begin, std::vector<double>::const_iterator end) {
  return begin == end ? 0.0 : std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
}

Json summarizeTimes(std::vector<double> step_ms) {
  const auto quarter = static_cast<std::ptrdiff_t>(step_ms.size() / 4);
  const double first_quarter_mean = meanOf(step_ms.cbegin(), step_ms.cbegin() + quarter);
  const double last_quarter_mean = meanOf(step_ms.cend() - quarter, step_ms.cend());
  std::sort(step_ms.begin(), step_ms.end());
  return {{"mean", meanOf(step_ms.cbegin(), step_ms.cend())},
          {"first_quarter_mean", first_quarter_mean},
          {"last_quarter_mean", last_quarter_mean},
          {"p50", quantileOf(step_ms, 0.5)},
          {"p95", quantileOf(step_ms, 0.95)},
          {"p99", quantileOf(step_ms, 0.99)},
          {"max", step_ms.back()}};
}

/// Mean, largest, and how often each number of hypotheses lived.
Json summarizeHypotheses(const std::vector<int>& hypotheses) {
  const double sum = std::accumulate(hypotheses.begin(), hypotheses.end(), 0.0);
  std::map<int, int> frames_with;
  for (const int count : hypotheses) ++frames_with[count];
  Json histogram = Json::object();
  for (const auto& [count, frames] : frames_with) histogram[std::to_string(count)] = frames;
  return {{"mean", sum / static_cast<double>(hypotheses.size())},
          {"max", *std::max_element(hypotheses.begin(), hypotheses.end())},
          {"frames_with", histogram}};
}

/// The upper triangle of a covariance, each number behind a comma.
template <class Matrix>
std::string formatUpper(const Matrix& cov) {
  std::string text;
  for (Eigen::Index row = 0; row < cov.rows(); ++row) {
    for (Eigen::Index column = row; column < cov.cols(); ++column) text += "," + formatDouble(cov(row, column));
  }
  return text;
}

/// Names of these numbers: position x, y, z, rotation a, b, c about the same axes.
std::string upperNames() {
  const std::string axes = "xyzabc";
  std::string text;
  for (std::size_t row = 0; row < axes.size(); ++row) {
    for (auto column = row; column < axes.size(); ++column) text += std::string(",cov_") + axes[row] + axes[column];
  }
  return text;
}

std::string formatCovariances(const std::vector<FixedAxesCov>& covs) {
  std::string text = "row" + upperNames() + "\n";
  for (std::size_t row = 0; row < covs.size(); ++row) text += std::to_string(row) + formatUpper(covs[row]) + "\n";
  return text;
}

std::string formatAssociations(const std::vector<DetectionAssociation>& associations) {
  std::string text = "frame,row,landmark,probability\n";
  for (const auto& [frame, row, landmark, probability] : associations) {
    text += std::to_string(frame) + "," + std::to_string(row) + ",";
    text += (landmark == kNoLandmark ? "-1" : std::to_string(landmark)) + "," + formatFixed(probability, 4) + "\n";
  }
  return text;
}

std::string formatLoopClosures(const std::vector<LoopClosureResult>& closures) {
  std::string text =
      "query_frame,match_frame,accepted,score,inliers,tx,ty,tz,qx,qy,qz,qw,source,reason,"
      "histogram_divergence,descriptor_score,topology_score,scene_score,loop_prob" +
      upperNames() + "\n";
  for (const auto& [query_frame, match_frame, record] : closures) {
    text += std::to_string(query_frame) + "," + std::to_string(match_frame) + "," + (record.is_accepted ? "1" : "0") +
            "," + formatFixed(record.score, 4) + "," + std::to_string(record.inliers);
    for (int i = 0; i < 3; ++i) text += "," + formatFixed(record.T_match_query.translation_m[i], 4);
    for (const double q : record.T_match_query.rotation.coeffs()) text += "," + formatFixed(q, 8);
    text += "," + nameOf(record.source) + "," + record.reason;
    const PlaceScores& place = record.place;
    for (const double score : {place.histogram_divergence, place.descriptor_score, place.topology_score,
                               place.scene_score, place.loop_prob}) {
      text += "," + formatFixed(score, 4);
    }
    text += formatUpper(inFixedAxes(record.T_match_query, record.cov)) + "\n";
  }
  return text;
}

/// Features are empty for a submap without landmarks.
std::string formatSubmaps(const std::vector<SubmapResult>& submaps) {
  std::string text = "submap,first_frame,checked,good_prob,entropy,tf_idf,landmarks\n";
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    const auto& [first_frame, check] = submaps[i];
    text += std::to_string(i) + "," + std::to_string(first_frame) + "," + (check.is_checked ? "1" : "0") + "," +
            formatFixed(check.evaluation.good_prob, 4);
    if (const auto& features = check.evaluation.features) {
      text += "," + formatFixed(features->entropy, 4) + "," + formatFixed(features->tf_idf, 4) + "," +
              std::to_string(features->landmarks) + "\n";
    } else {
      text += ",,,0\n";
    }
  }
  return text;
}

/// What the submap evaluator spared.
Json summarizeChecks(const std::vector<SubmapResult>& submaps) {
  const auto isChecked = [](const SubmapResult& submap) { return submap.check.is_checked; };
  const auto checked = static_cast<double>(std::count_if(submaps.begin(), submaps.end(), isChecked));
  const auto all = static_cast<double>(submaps.size());
  return {{"checked_submaps", static_cast<std::size_t>(checked)},
          {"skipped_share", submaps.empty() ? 0.0 : 1.0 - checked / all}};
}

/// How often landmarks became one, were kept apart though a closure or duplicate test joined them, and were split
/// again.
Json summarizeIdentity(const std::vector<IdentityEvent>& ledger) {
  std::map<IdentityEvent::Kind, std::size_t> counts;
  for (const IdentityEvent& event : ledger) ++counts[event.kind];
  return {{"merged", counts[IdentityEvent::Kind::kMerged]},
          {"kept_apart", counts[IdentityEvent::Kind::kKeptApart]},
          {"split", counts[IdentityEvent::Kind::kSplit]}};
}

std::size_t acceptedClosures(const std::vector<LoopClosureResult>& closures) {
  return static_cast<std::size_t>(std::count_if(
      closures.begin(), closures.end(), [](const LoopClosureResult& closure) { return closure.record.is_accepted; }));
}

double peakRssMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

Json toJson(const TrajectoryError& error) {
  Json json;
  for (const auto& [name, value] : namedFigures(error)) json[name] = value;
  return json;
}

Json toJson(const InputCounters& counters) {
  return {{"odometry", counters.odometry},
          {"odometry_invalid", counters.odometry_invalid},
          {"odometry_not_rising", counters.odometry_not_rising},
          {"odometry_outliers", counters.odometry_outliers},
          {"frames", counters.frames},
          {"frames_before_odometry", counters.frames_before_odometry},
          {"frames_not_rising", counters.frames_not_rising},
          {"frames_far_ahead", counters.frames_far_ahead},
          {"frames_in_odometry_gap", counters.frames_in_odometry_gap},
          {"frames_waiting_too_long", counters.frames_waiting_too_long},
          {"detections", counters.detections},
          {"detections_invalid", counters.detections_invalid},
          {"detections_at_origin", counters.detections_at_origin},
          {"covariances_unknown", counters.covariances_unknown},
          {"frames_standing", counters.frames_standing}};
}

Json toJson(const RefusedInput& refused) {
  std::size_t unknown_classes = 0;
  for (const auto& [id, count] : refused.unknown_classes) unknown_classes += count;
  return {{"odometry_wrong_frames", refused.odometry_wrong_frames},
          {"odometry_bad_stamps", refused.odometry_bad_stamps},
          {"odometry_stamp_outliers", refused.odometry_stamp_outliers},
          {"odometry_before_jump", refused.odometry_before_jump},
          {"frames_before_jump", refused.objects_before_jump},
          {"frames_bad_stamps", refused.objects_bad_stamps},
          {"frames_without_transform", refused.objects_without_transform},
          {"frames_in_map_frame", refused.objects_in_map_frame},
          {"detections_of_unknown_class", unknown_classes}};
}

Json toJson(const std::vector<SessionSummary>& sessions) {
  Json list = Json::array();
  for (const SessionSummary& session : sessions) {
    list.push_back({{"begin_s", secondsFromStamp(session.begin)}, {"is_located", session.is_located}});
  }
  return list;
}

Json toJson(const CoefficientEstimate& estimate) {
  return {{"mean", estimate.mean}, {"stddev", estimate.stddev}};
}

Json toJson(const OdometryModel& model) {
  return {{"along_m_per_sqrt_m", model.noise.along_m_per_sqrt_m},
          {"across_m_per_sqrt_m", model.noise.across_m_per_sqrt_m},
          {"up_m_per_sqrt_m", model.noise.up_m_per_sqrt_m},
          {"heading_rad_per_sqrt_m", model.noise.heading_rad_per_sqrt_m},
          {"heading_rad_per_sqrt_rad", model.noise.heading_rad_per_sqrt_rad},
          {"tilt_rad_per_sqrt_m", model.noise.tilt_rad_per_sqrt_m},
          {"scale_translation", toJson(model.systematic.scale_translation)},
          {"scale_turn", toJson(model.systematic.scale_turn)},
          {"heading_rad_per_m", toJson(model.systematic.heading_rad_per_m)},
          {"direction_m_per_m", toJson(model.systematic.direction_m_per_m)},
          {"lever_m_per_rad", toJson(model.systematic.lever_m_per_rad)}};
}

}  // namespace

std::optional<TrajectoryError> scoreRun(const Recording& recording, const std::vector<StampedPose>& trajectory) {
  std::map<Stamp, const Pose*> truth_at;
  for (const StampedPose& pose : recording.ground_truth) truth_at[pose.stamp] = &pose.T_world_base;
  std::vector<Pose> truth;
  std::vector<Pose> estimate;
  for (const auto& [stamp, T_map_base] : trajectory) {
    const auto found = truth_at.find(stamp);
    if (found == truth_at.end()) continue;
    truth.push_back(inOutputFrame(recording, *found->second));
    estimate.push_back(inOutputFrame(recording, T_map_base));
  }
  if (truth.empty()) return std::nullopt;
  return trajectoryError(truth, estimate);
}

void writeResultFiles(const std::string& folder, const Recording& recording, const RunResult& result,
                      const SystemConfig& config, const ClassTable& classes) {
  std::vector<Pose> poses;
  for (const auto& [stamp, T_map_base] : result.trajectory) poses.push_back(inOutputFrame(recording, T_map_base));
  writeFileAtomically(folder + "/trajectory.txt", formatKittiTrajectory(poses));
  writeFileAtomically(folder + "/trajectory.tum", formatTumTrajectory(result.trajectory));
  writeFileAtomically(folder + "/trajectory_online.tum", formatTumTrajectory(result.online_trajectory));
  writeFileAtomically(folder + "/trajectory_cov.csv", formatCovariances(result.trajectory_cov));
  writeFileAtomically(folder + "/trajectory_online_cov.csv", formatCovariances(result.online_trajectory_cov));
  writeFileAtomically(folder + "/loop_closures.csv", formatLoopClosures(result.loop_closures));
  writeFileAtomically(folder + "/submaps.csv", formatSubmaps(result.submap_checks));
  writeFileAtomically(folder + "/landmarks.csv", landmarksCsv(result.landmarks, classes));
  writeFileAtomically(folder + "/associations.csv", formatAssociations(result.associations));
  writeFileAtomically(folder + "/config.yaml", toYaml(config));
}

void writeReport(const std::string& folder, const Recording& recording, const RunResult& result,
                 const std::optional<TrajectoryError>& error, const SystemConfig& config, std::size_t map_bytes) {
  Json report = {{"method", nameOf(config.slam.method)},
                 {"seed", config.slam.seed},
                 {"frames", result.counters.frames},
                 {"odometry_samples", result.trajectory.size()},
                 {"seconds", result.seconds},
                 {"ms_per_frame", summarizeTimes(result.step_ms)},
                 {"mapping_ms_per_frame", summarizeTimes(result.mapping_ms)},
                 {"peak_rss_mb", peakRssMb()},
                 {"hypotheses", summarizeHypotheses(result.hypotheses)},
                 {"landmarks", result.landmarks.size()},
                 {"submaps", result.submaps},
                 {"place", summarizeChecks(result.submap_checks)},
                 {"loop_closures", acceptedClosures(result.loop_closures)},
                 {"identity", summarizeIdentity(result.identity)},
                 {"graph", {{"failures", result.graph.failures}, {"newest_failure", result.graph.newest_failure}}},
                 {"map_bytes", map_bytes},
                 {"input", toJson(result.counters)}};
  report["input"].update(toJson(recording.refused));
  report["input"]["dropped"] = droppedInput(result.counters, recording.refused, recording.names);
  const auto fixes = gnssReport(result.fixes, recording.refused, recording.names, result.geo_reference);
  if (fixes) report["fixes"] = *fixes;
  report["sessions"] = toJson(result.sessions);
  report["moving"] = {{"detections_flagged", result.moving.flagged}, {"detections_found", result.moving.found}};
  report["detector_range_m"] = result.detector_range_m;
  if (result.odometry_model) report["odometry_model"] = toJson(*result.odometry_model);
  if (error) report["error"] = toJson(*error);
  writeFileAtomically(folder + "/report.json", report.dump(2) + "\n");
}

}  // namespace semantic_mht_slam
