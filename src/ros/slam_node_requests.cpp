#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/map_path.h"
#include "semantic_mht_slam/ros/slam_node.h"

#include "saved_results.h"

// The services of a person who corrects the map, or takes results out of a node that runs.
namespace semantic_mht_slam {
namespace {

FixedAxesCov covarianceOf(const geometry_msgs::PoseWithCovariance& message) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.covariance.data());
}

}  // namespace

void SlamNode::advertiseRequests(ros::NodeHandle& handle) {
  services_.push_back(handle.advertiseService("remove_landmark", &SlamNode::removeLandmark, this));
  services_.push_back(handle.advertiseService("lock_landmark", &SlamNode::lockLandmark, this));
  services_.push_back(handle.advertiseService("add_closure", &SlamNode::addClosure, this));
  services_.push_back(handle.advertiseService("remove_closure", &SlamNode::removeClosure, this));
  services_.push_back(handle.advertiseService("save_results", &SlamNode::saveResults, this));
  services_.push_back(handle.advertiseService("get_map_updates", &SlamNode::getMapUpdates, this));
}

template <class Response, class Body>
bool SlamNode::change(const std::string& service, Response& response, const Body& body) {
  return answer(service, response, [&] {
    const auto lock = lockCaughtUp();
    try {
      response.message = body();
      response.success = true;
    } catch (const InputError& error) {
      response.message = error.what();
    }
    publishMap();
    published_odometry_ = 0;  // the trajectory may have been corrected
    noteStatus();
  });
}

bool SlamNode::getMapUpdates(GetMapUpdates::Request& request, GetMapUpdates::Response& response) {
  return answer("get_map_updates", response, [&] {
    const auto lock = lockCaughtUp();
    publisher_.updates().answer(request, response, *slam_);
  });
}

bool SlamNode::removeLandmark(RemoveLandmark::Request& request, RemoveLandmark::Response& response) {
  return change("remove_landmark", response, [&] {
    request.restore ? slam_->bringBackLandmark(request.id) : slam_->removeLandmark(request.id);
    const char* done = request.restore ? " is in the map again" : " is not in the map any more";
    return "landmark " + std::to_string(request.id) + done;
  });
}

bool SlamNode::lockLandmark(LockLandmark::Request& request, LockLandmark::Response& response) {
  return change("lock_landmark", response, [&] {
    request.unlock ? slam_->unlockLandmark(request.id) : slam_->lockLandmark(request.id);
    const char* done = request.unlock ? " follows its detections again" : " stays as it is";
    return "landmark " + std::to_string(request.id) + done;
  });
}

bool SlamNode::addClosure(AddClosure::Request& request, AddClosure::Response& response) {
  return change("add_closure", response, [&] {
    const ClosureId id = slam_->addClosure({toStamp(request.query_stamp), toStamp(request.match_stamp),
                                            fromMessage(request.transform.pose), covarianceOf(request.transform)});
    response.id = static_cast<std::uint32_t>(id.index());
    return "closure " + std::to_string(response.id) + " holds; it makes one landmark of two for " +
           std::to_string(slam_->map().closures()[id].pairs.size()) + " pairs";
  });
}

bool SlamNode::removeClosure(RemoveClosure::Request& request, RemoveClosure::Response& response) {
  return change("remove_closure", response, [&] {
    slam_->removeClosure(ClosureId(request.id));
    return "closure " + std::to_string(request.id) + " does not hold any more";
  });
}

bool SlamNode::saveResults(SaveResults::Request& request, SaveResults::Response& response) {
  return answer("save_results", response, [&] {
    std::optional<MapOrigin> origin;
    if (request.latitude != 0.0 || request.longitude != 0.0) {
      origin = MapOrigin{request.latitude, request.longitude, request.heading};
    }
    try {
      const std::string folder = resultsPath(request.path, config_.node.map_folder);
      if (origin) requireUsable(*origin);
      auto lock = lockCaughtUp();
      const TrajectoryRecord record = trajectoryRecordOf(*slam_);
      const std::vector<MixtureLandmark> landmarks = landmarksOf(*slam_);
      const std::optional<GeoReference> reference = geoReferenceOf(*slam_);
      if (!origin && reference) origin = originOf(*reference);
      lock.unlock();
      const std::vector<StampedPose> trajectory = trajectoryOf(record);
      semantic_mht_slam::saveResults(folder, trajectory, landmarks, classes_, origin);
      response.success = true;
      response.message = std::to_string(trajectory.size()) + " poses and " + std::to_string(landmarks.size()) +
                         " landmarks of finished submaps are in '" + folder + "'";
    } catch (const InputError& error) {
      response.message = error.what();
    }
  });
}

}  // namespace semantic_mht_slam
