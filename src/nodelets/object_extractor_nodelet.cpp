#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "semantic_mht_slam/ros/object_extractor.h"
#include "semantic_mht_slam/ros/parameters.h"

namespace semantic_mht_slam {

/// The object extractor inside a nodelet manager, so that clouds of the same manager are not copied.
class ObjectExtractorNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      extractor_ = std::make_unique<ObjectExtractor>(getNodeHandle(),
                                                     makeObjectExtractorSetup(readParameters(getPrivateNodeHandle())));
    } catch (const std::exception& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;  // the manager tells that loading has failed
    }
  }

  std::unique_ptr<ObjectExtractor> extractor_;
};

}  // namespace semantic_mht_slam

PLUGINLIB_EXPORT_CLASS(semantic_mht_slam::ObjectExtractorNodelet, nodelet::Nodelet)
