#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <semantic_mht_slam/AddMap.h>
#include <semantic_mht_slam/RemoveMap.h>
#include <semantic_mht_slam/SaveMap.h>

#include "semantic_mht_slam/app/map_server_config.h"
#include "semantic_mht_slam/ros/failure_guard.h"

#include "map_server_maps.h"
#include "map_server_robots.h"
#include "map_server_world.h"

namespace semantic_mht_slam {

/// The ROS node of the map server: topics `world/map`, `world/markers` and `merge_status`, latched; tf world ->
/// NAME/map; services `~add_map`, `~remove_map`, `~forget_map` and `~save_map`. One thread looks at the folder and
/// merges whenever something has changed; services are answered meanwhile.
class MapServerNode {
 public:
  /// Reads the maps to begin with. Throws InputError for one that cannot be used.
  MapServerNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const MapServerSetup& setup,
                const SlamConfig& slam_config, const ClassTable& classes);
  ~MapServerNode();

 private:
  void work();
  void lookAtFolder();
  void wake();
  void mergeAndPublish();
  void forgetChanged(const std::vector<ServedMap>& served);
  void publishStatus(bool is_merging);
  void requireOutsideOfFolder(const std::string& path) const;
  void waitUntilMerged();
  std::shared_ptr<const World> world() const;
  void advertiseServices(ros::NodeHandle private_handle);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& wrapper) const;
  bool isClosing() const { return is_closing_ || !ros::ok(); }

  template <class Response, class Body>
  bool answer(const std::string& service, Response& response, const Body& body);

  const MapServerSetup setup_;
  ServedMaps maps_;
  const WorldSettings world_settings_;
  std::map<std::string, std::size_t> generations_;  ///< that the memory knows, by name; the worker's
  PairMemory memory_;                               ///< the worker's
  mutable std::mutex mutex_;                        ///< guards the three below
  std::shared_ptr<const World> world_;
  MergeStatus status_;
  std::string folder_problem_;
  FailureGuard failures_;
  FailureGuard merging_failures_;
  std::atomic<std::size_t> merged_changes_ = 0;
  std::size_t published_news_ = 0;  ///< the worker's, as the next
  ros::WallTime next_merge_;        ///< not before, after one that failed
  std::atomic<bool> is_closing_ = false;
  ros::Publisher map_publisher_;
  ros::Publisher markers_publisher_;
  ros::Publisher status_publisher_;
  tf2_ros::StaticTransformBroadcaster transforms_;
  std::vector<ros::ServiceServer> services_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  std::mutex wake_mutex_;
  std::condition_variable wake_;
  bool is_woken_ = false;
  std::vector<std::unique_ptr<RobotFeed>> robots_;
  std::thread worker_;
};

}  // namespace semantic_mht_slam
