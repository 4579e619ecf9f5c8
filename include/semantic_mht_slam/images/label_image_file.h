#pragma once

#include <string>

#include "semantic_mht_slam/models/label_image.h"

namespace semantic_mht_slam {

/// Reads a label image: a file with one channel of 8 or 16 bit, for example PNG. Throws InputError naming the file if
/// it is missing, no image, or of another kind (a colour preview, say).
LabelImage readLabelImage(const std::string& path);

/// Writes a label image as 16 bit PNG. Throws InputError naming the file.
void writeLabelImage(const std::string& path, const LabelImage& image);

}  // namespace semantic_mht_slam
