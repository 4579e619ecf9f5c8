#pragma once

#include "semantic_mht_slam/models/camera.h"
#include "semantic_mht_slam/models/label_image.h"
#include "semantic_mht_slam/models/label_map.h"
#include "semantic_mht_slam/models/labelled_cloud.h"
#include "semantic_mht_slam/perception/extracted_object.h"
#include "semantic_mht_slam/perception/extraction_config.h"

namespace semantic_mht_slam {

/// Objects of a label image with the depth of a lidar, in the frame of the lidar (X-View's extraction with projected
/// Velodyne points). The points that fall into the blobs of a class are clustered in space, as in a labelled cloud,
/// since a blob may hold several things in a row and the ground or wall behind them, and one thing may be cut into
/// blobs. Clusters that shine through from behind another one of their blob are removed; of the others the points far
/// from the median range are removed and the rest is measured as in a labelled cloud. The cloud's labels are not used.
/// Points that are not finite or out of range and label ids that the map lacks (in pixels) are left out and counted.
/// Throws std::invalid_argument as `findBlobs` does.
Extraction extractObjects(const LabelledCloud& cloud, const LabelImage& image, const Camera& camera,
                          const LabelMap& labels, const ExtractionConfig& config);

}  // namespace semantic_mht_slam
