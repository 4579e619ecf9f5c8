#include "map_server_node.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/diagnosis.h"
#include "semantic_mht_slam/ros/map_path.h"

namespace semantic_mht_slam {
namespace {

constexpr bool kLatched = true;
constexpr auto kPeriod = std::chrono::seconds(1);

/// Merging is not wanted any more.
class GivenUp : public std::exception {};

std::vector<std::string> split(const std::string& paths) {
  std::vector<std::string> result;
  std::istringstream text(paths);
  for (std::string path; std::getline(text, path, ':');) {
    if (!path.empty()) result.push_back(path);
  }
  return result;
}

}  // namespace

MapServerNode::MapServerNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                             const MapServerSetup& setup, const SlamConfig& slam_config, const ClassTable& classes)
    : setup_(setup),
      maps_(setup.system, slam_config, classes, [this] { return !isClosing(); }),
      world_settings_{slam_config, classes, setup.server.world_frame},
      world_(std::make_shared<const World>(world_settings_)),
      diagnostics_(handle, private_handle, private_handle.getNamespace()) {
  ros::NodeHandle world_handle(handle);
  map_publisher_ = world_handle.advertise<SemanticMap>("world/map", 1, kLatched);
  markers_publisher_ = world_handle.advertise<visualization_msgs::MarkerArray>("world/markers", 1, kLatched);
  status_publisher_ = world_handle.advertise<MergeStatus>("merge_status", 1, kLatched);
  for (const std::string& path : split(setup.server.maps)) maps_.add(mapPath(path, setup.system.node.map_folder), "");
  if (!setup.server.folder.empty()) maps_.takeFolder(setup.server.folder);
  advertiseServices(private_handle);
  diagnostics_.setHardwareID(kDiagnosticsHardwareId);
  diagnostics_.add("maps", [this](diagnostic_updater::DiagnosticStatusWrapper& wrapper) { diagnose(wrapper); });
  diagnostics_timer_ = world_handle.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  for (const std::string& robot : split(setup.server.robots)) {
    robots_.push_back(std::make_unique<RobotFeed>(handle, robot, slam_config, classes, [this] { wake(); }));
  }
  worker_ = std::thread([this] { work(); });
}

MapServerNode::~MapServerNode() {
  is_closing_ = true;
  wake();
  worker_.join();
}

template <class Response, class Body>
bool MapServerNode::answer(const std::string& service, Response& response, const Body& body) {
  failures_.run(service, [&] {
    try {
      response.message = body();
      response.success = true;
    } catch (const InputError& error) {
      response.message = error.what();
    }
  });
  if (!response.success && response.message.empty()) response.message = failures_.status().newest;
  wake();
  return true;
}

void MapServerNode::advertiseServices(ros::NodeHandle private_handle) {
  const std::string folder = setup_.system.node.map_folder;
  const auto advertise = [&](const std::string& name, auto callback) {
    services_.push_back(private_handle.advertiseService(name, callback));
  };
  using AddCall = boost::function<bool(AddMap::Request&, AddMap::Response&)>;
  using RemoveCall = boost::function<bool(RemoveMap::Request&, RemoveMap::Response&)>;
  using SaveCall = boost::function<bool(SaveMap::Request&, SaveMap::Response&)>;
  advertise("add_map", AddCall([this, folder](AddMap::Request& request, AddMap::Response& response) {
              return answer("add_map", response, [&] {
                if (!request.path.empty()) return maps_.add(mapPath(request.path, folder), request.name);
                maps_.restore(request.name);
                return request.name;
              });
            }));
  advertise("remove_map", RemoveCall([this](RemoveMap::Request& request, RemoveMap::Response& response) {
              return answer("remove_map", response, [&] {
                maps_.remove(request.name);
                return "'" + request.name + "' is left out; add_map with this name and no path brings it back";
              });
            }));
  advertise("forget_map", RemoveCall([this](RemoveMap::Request& request, RemoveMap::Response& response) {
              return answer("forget_map", response, [&] {
                maps_.forget(request.name);
                return "'" + request.name + "' is forgotten";
              });
            }));
  advertise("save_map", SaveCall([this, folder](SaveMap::Request& request, SaveMap::Response& response) {
              return answer("save_map", response, [&] {
                const std::string path = mapPath(request.path, folder);
                requireOutsideOfFolder(path);
                waitUntilMerged();
                const SavedMap map = world()->saved();
                response.bytes = writeMapFile(path, map, setup_.system, world_settings_.classes);
                return std::to_string(map.landmarks.size()) + " landmarks are in '" + path + "'";
              });
            }));
}

/// Or the server would take its own result for one more map.
void MapServerNode::requireOutsideOfFolder(const std::string& path) const {
  std::error_code error;
  const std::filesystem::path into = std::filesystem::path(path).parent_path();
  if (setup_.server.folder.empty() || !std::filesystem::equivalent(into, setup_.server.folder, error)) return;
  throw InputError("'" + path + "' is in the folder whose maps are joined (server.folder)");
}

/// What was asked for before has its effect.
void MapServerNode::waitUntilMerged() {
  const std::size_t asked = maps_.changes();
  while (merged_changes_ < asked) {
    if (isClosing()) throw InputError("the server ends");
    if (merging_failures_.status().in_a_row > 0) {
      throw InputError("the maps cannot be merged: " + merging_failures_.status().newest);
    }
    ros::WallDuration(0.02).sleep();
  }
}

std::shared_ptr<const World> MapServerNode::world() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return world_;
}

void MapServerNode::wake() {
  {
    const std::lock_guard<std::mutex> lock(wake_mutex_);
    is_woken_ = true;
  }
  wake_.notify_all();
}

void MapServerNode::work() {
  bool is_first = true;
  while (!isClosing()) {
    lookAtFolder();
    for (const auto& robot : robots_) {
      failures_.run("listening to a robot", [&] {
        robot->catchUp();
        robot->takeNews(maps_);
      });
    }
    const ros::WallTime now = ros::WallTime::now();
    if (is_first || (maps_.changes() != merged_changes_ && now >= next_merge_)) {
      is_first = false;
      if (!merging_failures_.run("merging", [this] { mergeAndPublish(); })) {
        ROS_ERROR_STREAM("map_server: " << merging_failures_.status().newest << "; the world stays as it was");
        const auto in_a_row = std::min<std::size_t>(merging_failures_.status().in_a_row, 6);
        next_merge_ = now + ros::WallDuration(static_cast<double>(1U << in_a_row));
        publishStatus(false);
      }
    } else if (maps_.news() != published_news_) {
      publishStatus(false);
    }
    std::unique_lock<std::mutex> lock(wake_mutex_);
    wake_.wait_for(lock, kPeriod, [this] { return is_woken_; });
    is_woken_ = false;
  }
}

void MapServerNode::lookAtFolder() {
  if (setup_.server.folder.empty()) return;
  std::string problem;
  failures_.run("looking at server.folder", [this, &problem] {
    try {
      maps_.takeFolder(setup_.server.folder);
    } catch (const InputError& error) {
      problem = error.what();
    }
  });
  const std::lock_guard<std::mutex> lock(mutex_);
  folder_problem_ = problem;
}

void MapServerNode::mergeAndPublish() {
  const std::size_t changes = maps_.changes();
  const std::vector<ServedMap> served = maps_.list();
  publishStatus(true);
  forgetChanged(served);
  std::shared_ptr<const World> next;
  try {
    next = std::make_shared<const World>(world_settings_, served, memory_, [this](const std::string&) {
      if (isClosing()) throw GivenUp();
    });
  } catch (const GivenUp&) {
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    world_ = next;
  }
  merged_changes_ = changes;
  map_publisher_.publish(next->map());
  markers_publisher_.publish(next->markers());
  transforms_.sendTransform(next->transforms());
  publishStatus(false);
}

void MapServerNode::forgetChanged(const std::vector<ServedMap>& served) {
  std::map<std::string, std::size_t> now;
  for (const ServedMap& map : served) now[map.name] = map.generation;
  for (const auto& [name, generation] : generations_) {
    const auto found = now.find(name);
    if (found == now.end() || found->second != generation) memory_.forget(name);
  }
  generations_ = std::move(now);
}

void MapServerNode::publishStatus(bool is_merging) {
  published_news_ = maps_.news();
  MergeStatus status = world()->status(maps_.list());
  status.is_merging = is_merging;
  status_publisher_.publish(status);
  const std::lock_guard<std::mutex> lock(mutex_);
  status_ = status;
}

void MapServerNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& wrapper) const {
  using diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::size_t joined = 0;
  std::string problems = folder_problem_;
  for (const MapStatus& map : status_.maps) {
    if (map.state == MapStatus::JOINED) ++joined;
    if (!map.reason.empty()) problems += (problems.empty() ? "" : "; ") + map.name + ": " + map.reason;
  }
  const FailureStatus failures = failures_.status();
  const FailureStatus merging = merging_failures_.status();
  for (const FailureStatus& one : {failures, merging}) {
    if (one.in_a_row > 0) problems += (problems.empty() ? "" : "; ") + one.newest;
  }
  wrapper.summary(failures.isLasting() || merging.isLasting() ? DiagnosticStatus::ERROR
                  : problems.empty()                          ? DiagnosticStatus::OK
                                                              : DiagnosticStatus::WARN,
                  std::to_string(joined) + " of " + std::to_string(status_.maps.size()) + " maps are in one" +
                      (status_.is_merging ? ", merging" : "") + (problems.empty() ? "" : ": " + problems));
  wrapper.add("maps", status_.maps.size());
  wrapper.add("joined", joined);
  wrapper.add("landmarks", status_.landmarks);
  wrapper.add("unexpected failures", failures.count + merging.count);
}

}  // namespace semantic_mht_slam
