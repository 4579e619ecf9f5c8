#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

/// What an objects CSV holds.
struct ObjectsFile {
  std::vector<Detections> detections;  ///< by frame
  std::string notice;                  ///< of columns that were ignored (see `CsvReader::read`)
};

/// Reads an objects CSV: columns frame,class,x,y,z and optionally score, the covariance sxx,sxy,sxz,syy,syz,szz (all
/// six or none), the extents size_x,size_y,size_z (all three or none), the number of points and moving (0 or 1); metres
/// in the base frame; empty cells are unknown, and so are, as in messages, a score of -1 and a covariance or extents of
/// zeros. Returns `frames` lists; within a frame the order of the file. What is measured may be infinite or not a
/// number (see `isUsable`), as detectors write that. Throws InputError naming file, line and column for a cell that is
/// no number, a class that the table lacks and a frame outside [0, frames).
ObjectsFile readObjects(const std::string& path, const ClassTable& classes, std::size_t frames);

/// Writes an objects CSV with three decimals of a metre; optional columns appear if any detection has them.
std::string formatObjects(const std::vector<Detections>& detections, const ClassTable& classes);

}  // namespace semantic_mht_slam
