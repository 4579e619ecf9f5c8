#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>
#include <ros/package.h>

#include "semantic_mht_slam/ros/slam_node.h"

namespace semantic_mht_slam {

/// slam_node in a nodelet manager. What is wrong with the parameters is logged, and the nodelet is not loaded.
class SlamNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    // The program is the manager's, so the class tables are not beside it.
    const std::string config_folder = ros::package::getPath("semantic_mht_slam") + "/config";
    try {
      node_ = makeSlamNode(getNodeHandle(), getPrivateNodeHandle(), config_folder);
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      throw;
    }
  }

  std::unique_ptr<SlamNode> node_;
};

}  // namespace semantic_mht_slam

PLUGINLIB_EXPORT_CLASS(semantic_mht_slam::SlamNodelet, nodelet::Nodelet)
