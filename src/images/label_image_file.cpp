#include "semantic_mht_slam/images/label_image_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {

LabelImage readLabelImage(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError("cannot read '" + path + "': no such file" + (error ? " (" + error.message() + ")" : ""));
  }
  cv::Mat pixels;
  try {
    pixels = cv::imread(path, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // headers that lie about the size
    pixels.release();
  }
  if (pixels.empty()) throw InputError(path + ": not an image that can be read");
  if (pixels.type() != CV_8UC1 && pixels.type() != CV_16UC1) {
    throw InputError(path + ": a label image has one channel of 8 or 16 bit, this one has " +
                     std::to_string(pixels.channels()) + " of " + std::to_string(8 * pixels.elemSize1()) + " bit");
  }
  cv::Mat1w wide;
  pixels.convertTo(wide, CV_16U);
  LabelImage image{wide.cols, wide.rows, {}};
  image.labels.assign(wide.begin(), wide.end());
  return image;
}

void writeLabelImage(const std::string& path, const LabelImage& image) {
  cv::Mat1w pixels(image.height_px, image.width_px);
  std::copy(image.labels.begin(), image.labels.end(), pixels.begin());
  bool is_written = false;
  try {
    is_written = cv::imwrite(path, pixels);
  } catch (const cv::Exception&) {
    is_written = false;
  }
  if (!is_written) throw InputError("cannot write image '" + path + "'");
}

}  // namespace semantic_mht_slam
