#include "semantic_mht_slam/slam/back_end.h"

#include <algorithm>
#include <utility>

namespace semantic_mht_slam {
namespace {

constexpr double kSessionStddev_m = 1.0;  // of a pose by localization
constexpr double kSessionStddev_rad = 0.03;

/// Covariance of a step on the right of T_a_b from that of the position and heading of b in the axes of a.
PoseCov stepCov(const Eigen::Matrix4d& cov, const Pose& T_a_b, double tilt_stddev_rad) {
  const Eigen::Matrix3d R_b_a = T_a_b.rotation.toRotationMatrix().transpose();
  Eigen::Matrix<double, 6, 4> J = Eigen::Matrix<double, 6, 4>::Zero();
  J.topLeftCorner<3, 3>() = R_b_a;
  J.block<3, 1>(3, 3) = R_b_a.col(2);
  PoseCov result = J * cov * J.transpose();
  result.diagonal().tail<3>().array() += tilt_stddev_rad * tilt_stddev_rad;
  return 0.5 * (result + result.transpose());
}

PoseCov poseCov(double stddev_m, double stddev_rad) {
  PoseCov cov = PoseCov::Zero();
  cov.diagonal().head<3>().setConstant(stddev_m * stddev_m);
  cov.diagonal().tail<3>().setConstant(stddev_rad * stddev_rad);
  return cov;
}

LoopClosureRecord toRecord(PlaceMatch match, const std::vector<int>& keyframe_of_place) {
  LoopClosureRecord record;
  record.source = ClosureSource::kPlace;
  record.query_keyframe = keyframe_of_place[match.query];
  record.match_keyframe = keyframe_of_place[match.match];
  record.is_accepted = match.accepted;
  record.reason = reasonText(match.refusal);
  record.score = match.verification_score;
  record.place = {match.histogram_divergence, match.descriptor_score, match.topology_score, match.scene_score,
                  match.loop_prob};
  record.inliers = match.inliers;
  record.T_match_query = match.T_match_query;
  record.cov = match.cov;
  record.pairs = std::move(match.pairs);
  return record;
}

}  // namespace

void describe(BackEndConfig& config, Fields& fields) {
  fields.add("close_loops", config.close_loops, "Whether places that are seen again correct the trajectory.");
  fields.add("recognise_places", config.recognise_places,
             "Whether places are recognised by their objects alone, wherever the pose is believed to be.");
  fields.add("landmark_factors", config.landmark_factors, "Whether landmarks take part in the pose graph.");
  fields.add("closure_stride", config.closure_stride, "", {1, 1000}, "Every n-th keyframe is looked for in the map.");
  fields.add("max_closure_distance", config.max_closure_distance_m, "m", {0.1, 100.0},
             "A place is seen again if the sensor comes back at least so near.");
  fields.add("loop_cov_scale", config.loop_cov_scale, "", {0.01, 1e4}, "Factor on the covariance of a loop closure.");
  fields.add("loop_floor", config.loop_floor_m, "m", {0.001, 10.0}, "Least position deviation of a loop closure.");
  fields.add("loop_floor_rad", config.loop_floor_rad, "rad", {1e-5, 1.0}, "Least rotation deviation of one.");
  fields.group("keyframe", config.keyframe);
  fields.group("evaluator", config.evaluator);
  fields.group("place", config.place);
  fields.group("revisit", config.revisit);
  fields.group("graph", config.graph);
}

BackEnd::BackEnd(const BackEndConfig& config, const OdometryNoise& odometry, const ClassTable& classes)
    : config_(config),
      odometry_noise_(odometry),
      classes_(classes),
      graph_(config.graph),
      evaluator_(makeSubmapEvaluator(config.evaluator, config.evaluator.tree, classes.size())),
      places_(config.place, classes) {}

std::vector<MergedLandmark> BackEnd::add(std::vector<MapKeyframe> keyframes, const Submap& submap,
                                         const SubmapPrediction& prediction) {
  newly_merged_.clear();
  const std::size_t first_new = map_.keyframes.size();
  checks_.push_back({static_cast<int>(first_new), false, evaluator_.add(submap)});
  for (MapKeyframe& keyframe : keyframes) {
    addNode(keyframe);
    map_.keyframes.push_back(std::move(keyframe));
    map_.T_map_keyframe.push_back(graph_.pose(graph_.submaps() - 1));
  }
  for (const auto& [gone, survivor] : submap.merged) mergeLandmarks(gone, survivor);
  graph_.optimize();
  readBack();
  if (config_.close_loops && !keyframes.empty()) {
    if (submap.alignment) closeByHypotheses(first_new, *submap.alignment, prediction);
    if (config_.recognise_places) recognisePlaces(first_new, submap);
    if (config_.revisit.enabled) findRevisitsOf(first_new);
  }
  return std::exchange(newly_merged_, {});
}

void BackEnd::addNode(const MapKeyframe& keyframe) {
  SubmapNode node;
  const int index = graph_.submaps();
  if (index == 0) {
    node.T_previous_submap = keyframe.T_odom_base;
  } else if (T_map_odom_start_) {
    node.T_previous_submap = map_.T_map_keyframe.back().inverse() * (*T_map_odom_start_ * keyframe.T_odom_base);
    node.odometry_cov = poseCov(kSessionStddev_m, kSessionStddev_rad);
    T_map_odom_start_.reset();
  } else {
    const MapKeyframe& previous = map_.keyframes.back();
    node.T_previous_submap = previous.T_odom_base.inverse() * keyframe.T_odom_base;
    const double distance_m = std::max(0.1, keyframe.driven_m - previous.driven_m);
    node.odometry_cov = distance_m * poseCov(odometry_noise_.stddev_m, odometry_noise_.stddev_rad);
  }
  std::set<LandmarkId> taken;
  for (const KeyframeSighting& sighting : keyframe.sightings) {
    const ClassInfo& info = classes_[sighting.class_index];
    if (!config_.landmark_factors || !info.is_static || info.transition != Transition::kDirac) continue;
    const LandmarkId id = merged_ids_.resolve(sighting.landmark);
    if (!taken.insert(id).second) continue;
    keyframes_of_[id].insert(index);
    node.sightings.push_back({static_cast<std::int64_t>(id), sighting.position_m, sighting.cov_m2});
  }
  graph_.addSubmap(node);
}

void BackEnd::recognisePlaces(std::size_t first_new, const Submap& submap) {
  std::vector<Keyframe> keyframes;
  for (std::size_t k = first_new; k < map_.keyframes.size(); ++k) {
    if (k % static_cast<std::size_t>(config_.closure_stride) != 0) continue;
    const MapKeyframe& keyframe = map_.keyframes[k];
    const int index = static_cast<int>(checks_.size()) - 1;
    keyframes.push_back({keyframe.frame, index, keyframe.driven_m, keyframe.scene});
    keyframe_of_place_.push_back(static_cast<int>(k));
  }
  std::vector<Pose> poses;
  for (const int k : keyframe_of_place_) poses.push_back(map_.T_map_keyframe[static_cast<std::size_t>(k)]);
  SubmapCheck& check = checks_.back();
  check.is_checked = check.evaluation.worth_checking;
  const SubmapSummary summary{classHistogram(submap.landmarks, classes_.size()), check.is_checked};
  std::vector<LoopClosureRecord> records;
  for (PlaceMatch& match : places_.process(std::move(keyframes), poses, summary)) {
    records.push_back(toRecord(std::move(match), keyframe_of_place_));
  }
  close(std::move(records));
}

SubmapPrediction BackEnd::predict(const Pose& T_odom_submap) const {
  const Pose T_odom_keyframe = map_.keyframes.empty() ? T_odom_submap : map_.keyframes.back().T_odom_base;
  const double ahead_m = (T_odom_submap.translation_m - T_odom_keyframe.translation_m).norm();
  SubmapPrediction prediction;
  prediction.driven_m = map_.keyframes.empty() ? 0.0 : map_.keyframes.back().driven_m;
  const double drifted_m = std::max(0.0, prediction.driven_m + ahead_m - closed_at_m_);
  prediction.prior = driftPrior(T_map_odom() * T_odom_submap, drifted_m, config_.revisit);
  prediction.T_map_keyframe = map_.T_map_keyframe;
  return prediction;
}

void BackEnd::closeByHypotheses(std::size_t first_new, const MapAlignment& alignment,
                                const SubmapPrediction& prediction) {
  const Pose T_map_submap = prediction.prior.T_a_b * alignment.T_earlier_submap;
  std::optional<std::size_t> nearest;
  const auto distance = [&](std::size_t k) {
    return (prediction.T_map_keyframe[k].translation_m - T_map_submap.translation_m).norm();
  };
  for (std::size_t k = 0; k < prediction.T_map_keyframe.size(); ++k) {
    if (map_.keyframes[first_new].driven_m - map_.keyframes[k].driven_m < config_.revisit.min_driven_m) break;
    if (!nearest || distance(k) < distance(*nearest)) nearest = k;
  }
  if (!nearest) return;
  LoopClosureRecord record;
  record.source = ClosureSource::kHypotheses;
  record.query_keyframe = static_cast<int>(first_new);
  record.match_keyframe = static_cast<int>(*nearest);
  record.is_accepted = alignment.is_accepted;
  if (!alignment.is_accepted) record.reason = "the hypotheses do not agree";
  record.score = alignment.weight;
  record.inliers = alignment.matches;
  record.T_match_query = prediction.T_map_keyframe[*nearest].inverse() * T_map_submap;
  record.cov = stepCov(alignment.cov, alignment.T_earlier_submap, config_.revisit.alignment.tilt_stddev_rad);
  close({std::move(record)});
}

void BackEnd::findRevisitsOf(std::size_t first_new) {
  std::vector<LoopClosureRecord> found;
  for (std::size_t k = first_new; k < map_.keyframes.size(); ++k) {
    if (k % static_cast<std::size_t>(config_.closure_stride) != 0) continue;
    const double drifted_m = std::max(0.0, map_.keyframes[k].driven_m - closed_at_m_);
    for (auto& record : findRevisits(map_, static_cast<int>(k), drifted_m, classes_, config_.revisit)) {
      found.push_back(std::move(record));
    }
  }
  close(std::move(found));
}

void BackEnd::close(std::vector<LoopClosureRecord> records) {
  bool is_closed = false;
  for (LoopClosureRecord& record : records) {
    const double distance_m = record.T_match_query.translation_m.head<2>().norm();
    if (record.is_accepted && distance_m > config_.max_closure_distance_m) {
      record.is_accepted = false;
      record.reason = "the sensor did not come back near enough";
    }
    closures_.push_back(std::move(record));
    if (!closures_.back().is_accepted) continue;
    accept(closures_.back());
    const auto query = static_cast<std::size_t>(closures_.back().query_keyframe);
    closed_at_m_ = std::max(closed_at_m_, map_.keyframes[query].driven_m);
    is_closed = true;
  }
  if (!is_closed) return;
  graph_.optimize();
  readBack();
}

void BackEnd::accept(const LoopClosureRecord& record) {
  LoopConstraint loop;
  loop.from = record.match_keyframe;
  loop.to = record.query_keyframe;
  loop.T_from_to = record.T_match_query;
  loop.cov = config_.loop_cov_scale * record.cov;
  loop.cov.diagonal().head<3>().array() += config_.loop_floor_m * config_.loop_floor_m;
  loop.cov.diagonal().tail<3>().array() += config_.loop_floor_rad * config_.loop_floor_rad;
  graph_.addLoopClosure(loop);
  closure_of_loop_.push_back(static_cast<int>(closures_.size()) - 1);
  for (const auto& [query, match] : record.pairs) mergeLandmarks(query, match);
}

bool BackEnd::mergeLandmarks(LandmarkId merged, LandmarkId survivor) {
  merged = merged_ids_.resolve(merged);
  survivor = merged_ids_.resolve(survivor);
  if (merged == survivor) return false;
  const auto a = keyframes_of_.find(merged);
  const auto b = keyframes_of_.find(survivor);
  if (a == keyframes_of_.end() || b == keyframes_of_.end()) return false;
  for (const int keyframe : a->second) {
    if (b->second.count(keyframe) > 0) return false;  // seen side by side: two objects
  }
  graph_.mergeLandmarks(static_cast<std::int64_t>(merged), static_cast<std::int64_t>(survivor));
  b->second.insert(a->second.begin(), a->second.end());
  keyframes_of_.erase(a);
  merged_ids_.merge(merged, survivor);
  newly_merged_.push_back({merged, survivor});
  return true;
}

void BackEnd::readBack() {
  map_.T_map_keyframe = graph_.poses();
}

void BackEnd::finish() {
  if (graph_.submaps() == 0) return;
  graph_.optimizeFully();
  readBack();
  for (const LoopDecision& decision : graph_.loopDecisions()) {
    LoopClosureRecord& record =
        closures_[static_cast<std::size_t>(closure_of_loop_[static_cast<std::size_t>(decision.loop)])];
    if (decision.state == LoopState::kAccepted) continue;
    record.is_accepted = false;
    record.reason = "refused by the pose graph";
  }
}

void BackEnd::goOnAt(const Pose& T_map_odom, double driven_m) {
  T_map_odom_start_ = T_map_odom;
  closed_at_m_ = driven_m;
}

Pose BackEnd::T_map_odom() const {
  if (T_map_odom_start_) return *T_map_odom_start_;
  if (map_.keyframes.empty()) return Pose::identity();
  return map_.T_map_keyframe.back() * map_.keyframes.back().T_odom_base.inverse();
}

Pose BackEnd::T_map_submap(int submap) const {
  // A submap begins with its first keyframe.
  const auto keyframe = static_cast<std::size_t>(checks_.at(static_cast<std::size_t>(submap)).first_keyframe);
  return map_.T_map_keyframe[keyframe];
}

std::optional<Eigen::Vector3d> BackEnd::landmark(LandmarkId id) const {
  return graph_.landmark(static_cast<std::int64_t>(merged_ids_.resolve(id)));
}

}  // namespace semantic_mht_slam
