#include "semantic_mht_slam/perception/image_extractor.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/saturated.h"
#include "semantic_mht_slam/perception/cloud_extractor.h"
#include "semantic_mht_slam/perception/image_blobs.h"

namespace semantic_mht_slam {
namespace {

/// Points that fall into the blobs of one class.
struct SeenPoints {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector2f> pixels;
  std::vector<int> blobs;
  std::vector<bool> is_rim;
  std::vector<bool> is_moving;
};

/// A cluster of such points as the camera sees it.
struct Candidate {
  Cluster cluster;
  float range_m = 0.0F;  ///< median distance from the sensor
  int blob = 0;          ///< where most of it lies
  float rim_share = 0.0F;
  Eigen::AlignedBox2f box_px;
  Eigen::Vector2f center_px = Eigen::Vector2f::Zero();
};

std::vector<SeenPoints> assignToBlobs(const LabelledCloud& cloud, const LabelImage& image, const Camera& camera,
                                      const LabelMap& labels, const ImageBlobs& blobs, const ExtractionConfig& config,
                                      Extraction& extraction) {
  std::vector<SeenPoints> result(config.classes.size());
  for (const Eigen::Vector3f& point : cloud.points_m) {
    if (!point.allFinite()) {
      ++extraction.points_not_finite;
      continue;
    }
    const float range_m = point.norm();
    if (!(range_m >= config.min_range_m && range_m <= config.max_range_m)) {
      ++extraction.points_out_of_range;
      continue;
    }
    const std::optional<Eigen::Vector2d> pixel = camera.project(point.cast<double>());
    if (!pixel ||
        !(pixel->minCoeff() > -0.5 && pixel->x() < image.width_px - 0.5 && pixel->y() < image.height_px - 0.5))
      continue;
    const int column = std::clamp(saturatedInt(std::round(pixel->x())), 0, image.width_px - 1);
    const int row = std::clamp(saturatedInt(std::round(pixel->y())), 0, image.height_px - 1);
    const auto place =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width_px) + static_cast<std::size_t>(column);
    const int blob = blobs.blob_of_pixel[place];
    if (blob == ImageBlobs::kNone) continue;
    const ClassIndex class_index = blobs.class_of_blob[static_cast<std::size_t>(blob)];
    SeenPoints& same = result[static_cast<std::size_t>(class_index)];
    same.blobs.push_back(blob);
    same.points_m.push_back(point);
    same.pixels.emplace_back(pixel->cast<float>());
    same.is_rim.push_back(blobs.is_rim[place]);
    same.is_moving.push_back(labels.isMoving(image.at(column, row)));
  }
  return result;
}

template <class Number>
Number medianOf(std::vector<Number> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<float> rangesOf(const SeenPoints& points, const Cluster& cluster) {
  std::vector<float> ranges_m;
  ranges_m.reserve(cluster.size());
  for (const int i : cluster) ranges_m.push_back(points.points_m[static_cast<std::size_t>(i)].norm());
  return ranges_m;
}

Candidate toCandidate(const SeenPoints& points, const Cluster& cluster) {
  Candidate candidate;
  candidate.cluster = cluster;
  candidate.range_m = medianOf(rangesOf(points, cluster));
  std::vector<int> blobs;
  for (const int i : cluster) blobs.push_back(points.blobs[static_cast<std::size_t>(i)]);
  candidate.blob = medianOf(std::move(blobs));  // of more than half of the points, if there is such a one
  const float share = 1.0F / static_cast<float>(cluster.size());
  for (const int i : cluster) {
    const auto place = static_cast<std::size_t>(i);
    candidate.box_px.extend(points.pixels[place]);
    candidate.center_px += share * points.pixels[place];
    if (points.is_rim[place]) candidate.rim_share += share;
  }
  return candidate;
}

/// Whether a cluster is seen past a nearer one: it fills the rim of the blob, which masks do not get right to the
/// pixel, or lies, in the image, within the nearer one. Thin things are rim all over and need only share the bearing.
bool shinesThrough(const Candidate& candidate, const Candidate& nearer, const ClusterConfig& rule,
                   const ImageConfig& config) {
  if (candidate.blob != nearer.blob) return false;
  if (nearer.range_m + static_cast<float>(rule.tolerance_m) > candidate.range_m) return false;
  Eigen::AlignedBox2f box = nearer.box_px;
  const auto border = static_cast<float>(config.border_px);
  box.min().array() -= border;
  box.max().array() += border;
  if (rule.is_vertical) return candidate.center_px.x() >= box.min().x() && candidate.center_px.x() <= box.max().x();
  if (candidate.cluster.size() >= nearer.cluster.size()) return false;
  return candidate.rim_share > config.max_rim_share || box.contains(candidate.center_px);
}

std::vector<Candidate> withoutBackground(const std::vector<Candidate>& candidates, const ClusterConfig& rule,
                                         const ImageConfig& config) {
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates) {
    const auto is_before = [&](const Candidate& other) { return shinesThrough(candidate, other, rule, config); };
    if (std::none_of(candidates.begin(), candidates.end(), is_before)) result.push_back(candidate);
  }
  return result;
}

/// The points of a cluster whose range is near the median range.
Cluster gatedByRange(const SeenPoints& points, const Candidate& candidate, const ClusterConfig& rule,
                     const ImageConfig& config) {
  constexpr double kDeviationOfMad = 1.4826;  // of a normal distribution
  const std::vector<float> ranges_m = rangesOf(points, candidate.cluster);
  std::vector<float> distances_m = ranges_m;
  for (float& distance : distances_m) distance = std::abs(distance - candidate.range_m);
  const double deviation_m = kDeviationOfMad * medianOf(distances_m);
  const double gate_m = std::max(config.range_gate_mad * deviation_m, rule.tolerance_m);
  Cluster gated;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    if (distances_m[i] <= gate_m) gated.push_back(candidate.cluster[i]);
  }
  return gated;
}

/// Adds the objects of one class.
void addObjects(const SeenPoints& points, ClassIndex class_index, const ExtractionConfig& config,
                Extraction& extraction) {
  const ClusterConfig& rule = config.classes.at(static_cast<std::size_t>(class_index));
  std::vector<Candidate> candidates;
  for (const Cluster& cluster : clustersOf(points.points_m, rule, config.vertical)) {
    if (isLargeEnough(measureObject(points.points_m, cluster, class_index, config), rule)) {
      candidates.push_back(toCandidate(points, cluster));
    } else {
      ++extraction.small_clusters;
    }
  }
  for (const Candidate& candidate : withoutBackground(candidates, rule, config.image)) {
    const Cluster cluster = gatedByRange(points, candidate, rule, config.image);
    ExtractedObject object = measureObject(points.points_m, cluster, class_index, config);
    if (!isLargeEnough(object, rule)) {
      ++extraction.small_clusters;
      continue;
    }
    object.detection.is_moving = isMajority(points.is_moving, cluster);
    object.detection.row = static_cast<int>(extraction.objects.size());
    extraction.objects.push_back(object);
  }
}

}  // namespace

Extraction extractObjects(const LabelledCloud& cloud, const LabelImage& image, const Camera& camera,
                          const LabelMap& labels, const ExtractionConfig& config) {
  Extraction extraction;
  extraction.points = cloud.size();
  const ImageBlobs blobs = findBlobs(image, labels, static_cast<int>(config.classes.size()), config.image);
  for (std::size_t id = 0; id < blobs.unknown_pixels.size(); ++id) {
    const std::size_t pixels = blobs.unknown_pixels[id];
    if (pixels > 0) extraction.unknown_labels[static_cast<std::uint16_t>(id)] = pixels;
  }
  const std::vector<SeenPoints> points = assignToBlobs(cloud, image, camera, labels, blobs, config, extraction);
  for (std::size_t i = 0; i < points.size(); ++i) {
    addObjects(points[i], static_cast<ClassIndex>(i), config, extraction);
  }
  return extraction;
}

}  // namespace semantic_mht_slam
