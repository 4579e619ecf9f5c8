#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/models/camera.h"
#include "semantic_mht_slam/models/label_image.h"
#include "semantic_mht_slam/models/labelled_cloud.h"
#include "semantic_mht_slam/perception/segmentation_network.h"

namespace semantic_mht_slam {

/// Points of a cloud, and their labels if `label_field` is not empty. x, y and z are float32 or float64; labels any
/// integer (the low 16 bits count: above them SemanticKITTI has the instance) or a float32 of whole numbers.
/// Throws InputError naming the field for a cloud without points, of wrong endianness, with a missing field, a field
/// of another type or count, or less data than its header tells.
LabelledCloud fromMessage(const sensor_msgs::PointCloud2& message, const std::string& label_field);

/// Class ids of an image: mono8, 8UC1, mono16 or 16UC1. Throws InputError for another encoding, no pixels, wrong
/// endianness (16 bit) or less data than its header tells.
LabelImage fromMessage(const sensor_msgs::Image& message);

/// The rectified camera: its P, or its K where P is zero. Throws InputError if neither is a projection.
Camera fromMessage(const sensor_msgs::CameraInfo& message, const Pose& T_camera_sensor);

/// The pixels of an image of 8 bit a channel, without a copy: rgb8, bgr8, rgba8, bgra8 or mono8. Throws InputError for
/// another encoding, no pixels or less data than its header tells. The message must outlive the view.
ImageView viewOf(const sensor_msgs::Image& message);

}  // namespace semantic_mht_slam
