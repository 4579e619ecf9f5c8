#include "semantic_mht_slam/ros/sensor_conversions.h"

#include <cmath>
#include <cstring>
#include <vector>

#include <sensor_msgs/image_encodings.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

std::size_t bytesOf(std::uint8_t datatype) {
  switch (datatype) {
    case PointField::INT8:
    case PointField::UINT8:
      return 1;
    case PointField::INT16:
    case PointField::UINT16:
      return 2;
    case PointField::INT32:
    case PointField::UINT32:
    case PointField::FLOAT32:
      return 4;
    case PointField::FLOAT64:
      return 8;
    default:
      return 0;
  }
}

const PointField& findField(const PointCloud2& message, const std::string& name) {
  std::vector<std::string> names;
  for (const PointField& field : message.fields) {
    if (field.name != name) {
      names.push_back(field.name);
      continue;
    }
    const std::size_t bytes = bytesOf(field.datatype);
    if (bytes == 0) {
      throw InputError("field '" + name + "' has the unknown datatype " + std::to_string(field.datatype));
    }
    if (field.count > 1)
      throw InputError("field '" + name + "' has " + std::to_string(field.count) + " values a point");
    if (field.offset + bytes > message.point_step) {
      throw InputError("field '" + name + "' ends beyond point_step " + std::to_string(message.point_step));
    }
    return field;
  }
  throw InputError("no field '" + name + "', it has " + (names.empty() ? "no fields" : joined(names)));
}

template <class Number>
Number readAs(const std::uint8_t* at) {
  Number number;
  std::memcpy(&number, at, sizeof(number));
  return number;
}

/// Reads the coordinates of one axis.
class CoordinateReader {
 public:
  CoordinateReader(const PointCloud2& message, const std::string& name) {
    const PointField& field = findField(message, name);
    is_double_ = field.datatype == PointField::FLOAT64;
    if (!is_double_ && field.datatype != PointField::FLOAT32) {
      throw InputError("field '" + name + "' is neither float32 nor float64");
    }
    offset_ = field.offset;
  }

  float operator()(const std::uint8_t* point) const {
    return is_double_ ? static_cast<float>(readAs<double>(point + offset_)) : readAs<float>(point + offset_);
  }

 private:
  std::size_t offset_ = 0;
  bool is_double_ = false;
};

std::uint16_t fromFloat(float value, const std::string& name) {
  if (!(value >= 0.0F && value <= 65535.0F && std::floor(value) == value)) {
    throw InputError("field '" + name + "' holds a float32 that is no label id");
  }
  return static_cast<std::uint16_t>(value);
}

std::uint16_t readLabel(const std::uint8_t* at, std::uint8_t datatype, const std::string& name) {
  switch (datatype) {
    case PointField::INT8:
    case PointField::UINT8:
      return *at;
    case PointField::INT16:
    case PointField::UINT16:
      return readAs<std::uint16_t>(at);
    case PointField::INT32:
    case PointField::UINT32:
      return static_cast<std::uint16_t>(readAs<std::uint32_t>(at) & 0xFFFF);
    case PointField::FLOAT32:
      return fromFloat(readAs<float>(at), name);
    default:
      throw InputError("field '" + name + "' is float64, a label is an integer or float32");
  }
}

/// Throws unless `rows` rows of `row_bytes` lie in the data and each holds `used_bytes`.
void requireData(std::uint64_t data_bytes, std::uint64_t rows, std::uint64_t row_bytes, std::uint64_t used_bytes) {
  if (used_bytes > row_bytes) {
    throw InputError("rows of " + std::to_string(used_bytes) + " bytes are longer than their step, " +
                     std::to_string(row_bytes) + " bytes");
  }
  if (rows > 0 && (rows - 1) * row_bytes + used_bytes > data_bytes) {
    throw InputError("field 'data' has " + std::to_string(data_bytes) + " bytes, the header tells of " +
                     std::to_string(rows) + " rows of " + std::to_string(row_bytes));
  }
}

void requireData(const sensor_msgs::Image& message, int channels, int bytes_per_channel) {
  if (message.width == 0 || message.height == 0) throw InputError("the image has no pixels (width, height)");
  constexpr std::uint32_t kLargestSide = 1 << 16;
  if (message.width > kLargestSide || message.height > kLargestSide)
    throw InputError("width or height is beyond 65536");
  requireData(message.data.size(), message.height, message.step,
              std::uint64_t{message.width} * static_cast<unsigned>(channels * bytes_per_channel));
}

}  // namespace

LabelledCloud fromMessage(const PointCloud2& message, const std::string& label_field) {
  const std::uint64_t points = std::uint64_t{message.width} * message.height;
  if (points == 0) throw InputError("the cloud has no points (width x height is 0)");
  if (message.is_bigendian) throw InputError("the cloud is big-endian (field 'is_bigendian')");
  requireData(message.data.size(), message.height, message.row_step, std::uint64_t{message.width} * message.point_step);
  const CoordinateReader x(message, "x");
  const CoordinateReader y(message, "y");
  const CoordinateReader z(message, "z");
  const PointField* label = label_field.empty() ? nullptr : &findField(message, label_field);

  LabelledCloud cloud;
  cloud.reserve(points);
  for (std::size_t row = 0; row < message.height; ++row) {
    const std::uint8_t* point = message.data.data() + row * message.row_step;
    for (std::size_t column = 0; column < message.width; ++column, point += message.point_step) {
      cloud.points_m.emplace_back(x(point), y(point), z(point));
      if (label != nullptr) cloud.labels.push_back(readLabel(point + label->offset, label->datatype, label_field));
    }
  }
  return cloud;
}

LabelImage fromMessage(const sensor_msgs::Image& message) {
  namespace encodings = sensor_msgs::image_encodings;
  const bool is_narrow = message.encoding == encodings::MONO8 || message.encoding == encodings::TYPE_8UC1;
  const bool is_wide = message.encoding == encodings::MONO16 || message.encoding == encodings::TYPE_16UC1;
  if (!is_narrow && !is_wide) {
    throw InputError("field 'encoding' is '" + message.encoding + "', class ids are mono8 or 16UC1");
  }
  if (is_wide && message.is_bigendian) throw InputError("the image is big-endian (field 'is_bigendian')");
  const std::size_t bytes = is_wide ? 2 : 1;
  requireData(message, 1, static_cast<int>(bytes));
  LabelImage image{static_cast<int>(message.width), static_cast<int>(message.height), {}};
  image.labels.reserve(std::size_t{message.width} * message.height);
  for (std::size_t row = 0; row < message.height; ++row) {
    const std::uint8_t* pixel = message.data.data() + row * message.step;
    for (std::size_t column = 0; column < message.width; ++column, pixel += bytes) {
      image.labels.push_back(is_wide ? readAs<std::uint16_t>(pixel) : *pixel);
    }
  }
  return image;
}

Camera fromMessage(const sensor_msgs::CameraInfo& message, const Pose& T_camera_sensor) {
  Camera camera;
  camera.T_camera_sensor = T_camera_sensor;
  camera.projection = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(message.P.data());
  if (camera.projection.isZero(0.0)) {
    camera.projection.leftCols<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.K.data());
  }
  const auto& P = camera.projection;
  if (!P.allFinite() || !(P(0, 0) > 0.0 && P(1, 1) > 0.0) || P(2, 2) != 1.0) {
    throw InputError("the camera is not calibrated (fields 'P' and 'K')");
  }
  return camera;
}

ImageView viewOf(const sensor_msgs::Image& message) {
  namespace encodings = sensor_msgs::image_encodings;
  ImageView view;
  if (message.encoding == encodings::MONO8) {
    view.channels = 1;
  } else if (message.encoding == encodings::RGBA8 || message.encoding == encodings::BGRA8) {
    view.channels = 4;
  } else if (message.encoding != encodings::RGB8 && message.encoding != encodings::BGR8) {
    throw InputError("field 'encoding' is '" + message.encoding + "', expected is rgb8, bgr8, rgba8, bgra8 or mono8");
  }
  requireData(message, view.channels, 1);
  view.is_red_first = message.encoding != encodings::BGR8 && message.encoding != encodings::BGRA8;
  view.width_px = static_cast<int>(message.width);
  view.height_px = static_cast<int>(message.height);
  view.row_bytes = message.step;
  view.data = message.data.data();
  return view;
}

}  // namespace semantic_mht_slam
