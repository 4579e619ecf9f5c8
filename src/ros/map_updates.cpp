#include "semantic_mht_slam/ros/map_updates.h"

#include <algorithm>
#include <random>
#include <utility>

#include "semantic_mht_slam/bags/map_update_conversions.h"

namespace semantic_mht_slam {
namespace {

constexpr std::uint32_t kUpdateQueue = 1000;
constexpr std::size_t kMostAtOnce = 200;  // submaps in a message: a megabyte, about

/// Different from that of any other map, and from that of a map in a file.
std::uint64_t newMapId() {
  std::random_device source;
  const std::uint64_t high = source();
  return (high << 32U | source()) | 1U;
}

}  // namespace

MapUpdates::MapUpdates(ros::NodeHandle& handle, std::string map_frame, const ClassTable& classes)
    : map_frame_(std::move(map_frame)),
      classes_(classes),
      publisher_(handle.advertise<MapUpdate>("map_update", kUpdateQueue)),
      map_id_(newMapId()) {}

MapUpdate MapUpdates::updateOf(const Slam& slam, SubmapId submap) const {
  MapUpdate update = toMessage(slam.parts(), submap, classes_);
  update.header.frame_id = map_frame_;
  update.map_id = map_id_;
  return update;
}

void MapUpdates::publishNew(const Slam& slam) {
  const std::size_t finished = slam.map().submaps().size();
  for (; published_ < finished; ++published_) {
    if (publisher_.getNumSubscribers() > 0) publisher_.publish(updateOf(slam, SubmapId(published_)));
  }
}

void MapUpdates::startAgain() {
  map_id_ = newMapId();
  published_ = 0;
}

void MapUpdates::answer(const GetMapUpdates::Request& request, GetMapUpdates::Response& response,
                        const Slam& slam) const {
  const std::size_t finished = slam.map().submaps().size();
  const std::size_t first = request.map_id == map_id_ ? std::min<std::size_t>(request.first, finished) : 0;
  const std::size_t end = std::min(finished, first + kMostAtOnce);
  response.map_id = map_id_;
  response.submaps = static_cast<std::uint32_t>(finished);
  for (std::size_t submap = first; submap < end; ++submap) {
    response.updates.push_back(updateOf(slam, SubmapId(submap)));
  }
  response.success = true;
  response.message = std::to_string(response.updates.size()) + " of " + std::to_string(finished) + " submaps";
}

}  // namespace semantic_mht_slam
