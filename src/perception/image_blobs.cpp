#include "semantic_mht_slam/perception/image_blobs.h"

#include <stdexcept>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace semantic_mht_slam {
namespace {

void requireWhole(const LabelImage& image) {
  const auto pixels =
      static_cast<std::size_t>(std::max(image.width_px, 0)) * static_cast<std::size_t>(std::max(image.height_px, 0));
  if (image.labels.size() != pixels) {
    throw std::invalid_argument("findBlobs: " + std::to_string(image.labels.size()) + " labels for " +
                                std::to_string(pixels) + " pixels");
  }
}

/// Class index + 1 of each pixel, 0 for what is no object.
cv::Mat1w classImage(const LabelImage& image, const LabelMap& labels, std::vector<std::size_t>& unknown_pixels,
                     std::vector<cv::Rect>& extents) {
  cv::Mat1w result(image.height_px, image.width_px);
  for (int row = 0; row < image.height_px; ++row) {
    for (int column = 0; column < image.width_px; ++column) {
      const std::uint16_t label = image.at(column, row);
      const ClassIndex class_index = labels.classOf(label);
      if (class_index == LabelMap::kUnknown) ++unknown_pixels[label];
      result(row, column) = static_cast<std::uint16_t>(std::max(class_index, -1) + 1);
      if (class_index >= 0) extents.at(static_cast<std::size_t>(class_index)) |= cv::Rect(column, row, 1, 1);
    }
  }
  return result;
}

/// Adds the blobs of one class, whose pixels all lie in `area`.
void addBlobs(const cv::Mat1w& class_image, const cv::Rect& area, ClassIndex class_index, const ImageConfig& config,
              ImageBlobs& blobs) {
  const cv::Mat mask = class_image(area) == class_index + 1;
  cv::Mat closed;
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {config.close_px, config.close_px});
  cv::morphologyEx(mask, closed, cv::MORPH_CLOSE, square);
  const int rim_px = 2 * config.border_px + 1;
  cv::Mat core;
  cv::erode(closed, core, cv::getStructuringElement(cv::MORPH_RECT, {rim_px, rim_px}), {-1, -1}, 1, cv::BORDER_CONSTANT,
            cv::Scalar(0));
  cv::Mat1i components;
  cv::Mat1i statistics;
  cv::Mat1d centers;
  const int count = cv::connectedComponentsWithStats(closed, components, statistics, centers, 8, CV_32S);
  std::vector<int> blob_of(static_cast<std::size_t>(count), ImageBlobs::kNone);
  for (int i = 1; i < count; ++i) {  // component 0 is what lies outside
    if (statistics(i, cv::CC_STAT_AREA) < config.min_pixels) continue;
    blob_of[static_cast<std::size_t>(i)] = static_cast<int>(blobs.class_of_blob.size());
    blobs.class_of_blob.push_back(class_index);
  }
  for (int row = 0; row < area.height; ++row) {
    for (int column = 0; column < area.width; ++column) {
      if (mask.at<std::uint8_t>(row, column) == 0) continue;
      const auto pixel = static_cast<std::size_t>(area.y + row) * static_cast<std::size_t>(blobs.width_px) +
                         static_cast<std::size_t>(area.x + column);
      blobs.blob_of_pixel[pixel] = blob_of[static_cast<std::size_t>(components(row, column))];
      blobs.is_rim[pixel] = core.at<std::uint8_t>(row, column) == 0;
    }
  }
}

}  // namespace

ImageBlobs findBlobs(const LabelImage& image, const LabelMap& labels, int classes, const ImageConfig& config) {
  requireWhole(image);
  ImageBlobs blobs;
  blobs.width_px = image.width_px;
  blobs.blob_of_pixel.assign(image.labels.size(), ImageBlobs::kNone);
  blobs.is_rim.assign(image.labels.size(), false);
  blobs.unknown_pixels.assign(LabelMap::kMaxId + 1, 0);
  std::vector<cv::Rect> extents(static_cast<std::size_t>(classes));
  const cv::Mat1w class_image = classImage(image, labels, blobs.unknown_pixels, extents);
  for (ClassIndex c = 0; c < classes; ++c) {
    const cv::Rect& area = extents[static_cast<std::size_t>(c)];
    if (!area.empty()) addBlobs(class_image, area, c, config, blobs);
  }
  return blobs;
}

}  // namespace semantic_mht_slam
