#include "map_server_robots.h"

#include <algorithm>
#include <utility>

#include <semantic_mht_slam/GetMapUpdates.h>

#include "semantic_mht_slam/bags/map_update_conversions.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/service_call.h"

namespace semantic_mht_slam {
namespace {

constexpr std::uint32_t kQueue = 1000;
constexpr double kSilence_s = 5.0;  // after which a robot is asked whether there is something new

std::string nameOfRobot(const std::string& robot) {
  std::string name = robot.substr(std::min(robot.find_first_not_of('/'), robot.size()));
  std::replace(name.begin(), name.end(), '/', '_');
  return name.empty() ? "robot" : name;
}

}  // namespace

RobotFeed::RobotFeed(ros::NodeHandle handle, const std::string& robot, SlamConfig config, ClassTable classes,
                     std::function<void()> on_news)
    : name_(nameOfRobot(robot)),
      topic_(ros::names::resolve(robot + "/map_update")),
      service_(ros::names::resolve(robot + "/get_map_updates")),
      config_(std::move(config)),
      classes_(std::move(classes)),
      on_news_(std::move(on_news)),
      subscriber_(handle.subscribe<MapUpdate>(
          topic_, kQueue, boost::function<void(const MapUpdateConstPtr&)>([this](const MapUpdateConstPtr& update) {
            {
              const std::lock_guard<std::mutex> lock(mutex_);
              take(*update);
            }
            on_news_();
          }))) {}

void RobotFeed::requireMap(std::uint64_t map_id) {
  if (map_id == map_id_) return;
  begins_anew_ = begins_anew_ || !map_.deltas.empty();
  map_id_ = map_id;
  map_ = {};
}

void RobotFeed::take(const MapUpdate& update) {
  requireMap(update.map_id);
  const std::size_t known = map_.deltas.size();
  if (update.number > known) {
    has_gap_ = true;
    return;
  }
  try {
    MapDelta delta = fromMessage(update, classes_);
    if (update.number == known) {
      map_.deltas.push_back(std::move(delta));
      map_.range_factor = update.range_factor;
      has_changed_ = true;
    } else if (map_.deltas[update.number].closures.size() != delta.closures.size()) {
      map_.deltas[update.number] = std::move(delta);  // a person has added one
      has_changed_ = true;
    }
    if (update.number + 1 < map_.deltas.size()) return;  // what holds is what the newest says
    std::vector<bool> held = heldClosures(update);
    has_changed_ = has_changed_ || held != map_.held;
    map_.held = std::move(held);
    frame_ = update.header.frame_id;
    problem_.clear();
  } catch (const InputError& error) {
    problem_ = error.what();
    has_changed_ = true;
    warnings_.warn(topic_ + ": " + problem_);
  }
}

void RobotFeed::catchUp() {
  GetMapUpdates call;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const ros::WallTime now = ros::WallTime::now();
    if (!has_gap_ && now < next_question_) return;
    next_question_ = now + ros::WallDuration(kSilence_s);
    call.request.map_id = map_id_;
    // The newest once more: its closures may have changed.
    call.request.first = static_cast<std::uint32_t>(map_.deltas.empty() ? 0 : map_.deltas.size() - 1);
  }
  if (!ros::service::exists(service_, false) || !callService(service_, call) || !call.response.success) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  requireMap(call.response.map_id);
  for (const MapUpdate& update : call.response.updates) take(update);
  has_gap_ = map_.deltas.size() < call.response.submaps && problem_.empty();
}

void RobotFeed::takeNews(ServedMaps& maps) {
  MapByDeltas map;
  ServedMap served;
  served.name = name_;
  served.source = topic_;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (std::exchange(begins_anew_, false)) maps.retire(topic_);
    if (!std::exchange(has_changed_, false)) return;
    map = map_;
    served.frame = frame_;
    served.problem = problem_;
  }
  try {
    if (!map.deltas.empty()) served.parts = std::make_shared<const SlamParts>(makeMap(map, config_, classes_));
  } catch (const std::exception& error) {
    served.problem = error.what();
  }
  maps.put(std::move(served));
}

}  // namespace semantic_mht_slam
