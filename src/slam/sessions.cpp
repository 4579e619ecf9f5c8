#include "semantic_mht_slam/slam/sessions.h"

#include <algorithm>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"

namespace semantic_mht_slam {
namespace {

constexpr double kStandingStep_m = 0.05;  // of a stand-still, of which only the ends are kept

}  // namespace

void Sessions::add(const StampedPose& T_odom_base, bool is_standing) {
  const bool has_begun = odometry_.size() > sessions_.back().first_odometry + 1;
  if (is_standing && has_begun) odometry_.pop_back();
  odometry_.push_back(T_odom_base);
}

void Sessions::begin(KeyframeId next) {
  sessions_.push_back({odometry_.size(), next, {}});
}

void Sessions::append(const Sessions& other, KeyframeId first,
                      const std::function<Pose(const Pose& T_other_base)>& T_map_other) {
  const bool is_unused = latestOdometry() == std::nullopt && sessions_.back().fixes.empty();
  if (is_unused) sessions_.pop_back();
  for (Session session : other.sessions_) {
    session.first_odometry += odometry_.size();
    session.first_keyframe = KeyframeId(first.index() + session.first_keyframe.index());
    for (MapFix& fix : session.fixes) fix.T_map_base = T_map_other(fix.T_map_base);
    sessions_.push_back(std::move(session));
  }
  odometry_.insert(odometry_.end(), other.odometry_.begin(), other.odometry_.end());
}

std::optional<StampedPose> Sessions::latestOdometry() const {
  if (odometry_.size() == sessions_.back().first_odometry) return std::nullopt;
  return odometry_.back();
}

const MapFix* Sessions::latestFix() const {
  const std::vector<MapFix>& fixes = sessions_.back().fixes;
  return fixes.empty() ? nullptr : &fixes.back();
}

std::vector<StampedPose> Sessions::odometryAfter(Stamp stamp) const {
  const auto begin = odometry_.begin() + sessions_.back().first_odometry;
  const auto first = std::upper_bound(begin, odometry_.end(), stamp,
                                      [](Stamp earlier, const StampedPose& pose) { return earlier < pose.stamp; });
  return {first, odometry_.end()};
}

std::optional<Pose> Sessions::odometryAt(Stamp stamp, double max_gap_s) const {
  const auto begin = odometry_.begin() + sessions_.back().first_odometry;
  const auto after = std::lower_bound(begin, odometry_.end(), stamp,
                                      [](const StampedPose& pose, Stamp earlier) { return pose.stamp < earlier; });
  if (after == odometry_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->T_world_base;
  if (after == begin) return std::nullopt;
  const StampedPose& before = *std::prev(after);
  const Stamp gap = after->stamp - before.stamp;
  const double step_m = (after->T_world_base.translation_m - before.T_world_base.translation_m).norm();
  if (gap > stampFromSeconds(max_gap_s) && step_m > kStandingStep_m) return std::nullopt;
  const double fraction = static_cast<double>(stamp - before.stamp) / static_cast<double>(gap);
  return interpolate(before.T_world_base, after->T_world_base, fraction);
}

bool Sessions::beginsAt(KeyframeId keyframe) const {
  return std::any_of(sessions_.begin(), sessions_.end(),
                     [&](const Session& session) { return session.first_keyframe == keyframe; });
}

bool Sessions::isNewestFix(const Map& map, KeyframeId keyframe) const {
  const MapFix* fix = latestFix();
  return keyframe >= sessions_.back().first_keyframe &&
         (fix == nullptr || fix->stamp < map.keyframes()[keyframe].stamp);
}

TrajectoryRecord Sessions::record(const Map& map, const MapUncertainty& uncertainty) const {
  TrajectoryRecord record{odometry_, {}};
  KeyframeId next(0);
  for (auto session = sessions_.begin(); session != sessions_.end(); ++session) {
    record.sessions.push_back({session->first_odometry, session->fixes});
    const auto after = session + 1;
    for (const KeyframeId end = after == sessions_.end() ? map.keyframes().nextId() : after->first_keyframe; next < end;
         ++next) {
      const Keyframe& keyframe = map.keyframes()[next];
      const bool is_known = uncertainty.keyframes.has(next);
      record.sessions.back().fixes.push_back({keyframe.stamp, keyframe.T_odom_base, map.T_map_keyframe(next),
                                              is_known ? uncertainty.keyframes[next] : unknownPoseCov()});
    }
  }
  return record;
}

std::vector<SessionSummary> Sessions::summary(const Map& map) const {
  std::vector<SessionSummary> result;
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const Session& session = sessions_[s];
    if (session.first_odometry >= odometry_.size()) continue;
    const KeyframeId end = s + 1 == sessions_.size() ? map.keyframes().nextId() : sessions_[s + 1].first_keyframe;
    const bool is_located = !session.fixes.empty() || session.first_keyframe < end;
    result.push_back({odometry_[session.first_odometry].stamp, is_located});
  }
  return result;
}

void transfer(StateArchive& archive, MapFix& fix) {
  auto& [stamp, T_odom_base, T_map_base, cov] = fix;
  archive(stamp, T_odom_base, T_map_base, cov);
  archive.requireStamp(stamp);
  archive.require(isNotNegative(cov), "a covariance of a place found that is none");
}

void Sessions::Session::transfer(StateArchive& archive) {
  archive(first_odometry, first_keyframe, fixes);
}

void Sessions::transfer(StateArchive& archive) {
  archive(odometry_, sessions_);
  archive.require(!sessions_.empty() && sessions_.front().first_odometry == 0 &&
                      sessions_.back().first_odometry <= odometry_.size(),
                  "sessions of no odometry");
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const std::size_t begin = sessions_[s].first_odometry;
    const std::size_t end = s + 1 == sessions_.size() ? odometry_.size() : sessions_[s + 1].first_odometry;
    archive.require(begin <= end, "sessions that are not in order");
    for (std::size_t i = begin; archive.isReading() && i + 1 < end; ++i) {
      archive.require(odometry_[i].stamp < odometry_[i + 1].stamp, "odometry whose stamps do not rise");
    }
  }
}

bool Sessions::fits(const Map& map) const {
  KeyframeId before(0);
  for (const Session& session : sessions_) {
    if (session.first_keyframe < before || session.first_keyframe > map.keyframes().nextId()) return false;
    before = session.first_keyframe;
  }
  return true;
}

}  // namespace semantic_mht_slam
