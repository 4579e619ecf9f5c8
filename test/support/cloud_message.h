#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <sensor_msgs/PointCloud2.h>

#include "semantic_mht_slam/models/labelled_cloud.h"

namespace semantic_mht_slam {

/// A cloud with float32 x, y, z and a uint32 label, with a gap of 4 bytes between them.
inline sensor_msgs::PointCloud2 makeCloudMessage(const LabelledCloud& cloud, const std::string& frame,
                                                 const ros::Time& stamp) {
  sensor_msgs::PointCloud2 message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  const std::vector<std::string> names = {"x", "y", "z", "label"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    sensor_msgs::PointField field;
    field.name = names[i];
    field.offset = static_cast<std::uint32_t>(i == 3 ? 16 : 4 * i);
    field.datatype = i == 3 ? sensor_msgs::PointField::UINT32 : sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.height = 1;
  message.width = static_cast<std::uint32_t>(cloud.size());
  message.point_step = 20;
  message.row_step = message.width * message.point_step;
  message.data.resize(message.row_step);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint8_t* point = message.data.data() + i * message.point_step;
    const std::uint32_t label = 0x00050000U | cloud.labels[i];  // an instance above the class
    std::memcpy(point, cloud.points_m[i].data(), 12);
    std::memcpy(point + 16, &label, 4);
  }
  return message;
}

}  // namespace semantic_mht_slam
