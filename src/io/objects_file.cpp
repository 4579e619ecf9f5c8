#include "semantic_mht_slam/io/objects_file.h"

#include <algorithm>
#include <array>
#include <map>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/csv_file.h"

namespace semantic_mht_slam {
namespace {

enum Column : std::size_t { kFrame, kClass, kX, kY, kZ, kScore, kCov, kSize = kCov + 6, kPoints = kSize + 3, kMoving };

const std::vector<std::string> kRequired = {"frame", "class", "x", "y", "z"};
const std::vector<std::string> kOptional = {"score", "sxx",    "sxy",    "sxz",    "syy",    "syz",
                                            "szz",   "size_x", "size_y", "size_z", "points", "moving"};

/// The numbers of a group of columns that is given whole or not at all.
template <std::size_t N>
std::optional<std::array<double, N>> readGroup(const CsvRow& row, std::size_t first) {
  std::array<double, N> numbers{};
  std::size_t given = 0;
  for (std::size_t i = 0; i < N; ++i) {
    if (const auto number = row.optionalAnyNumber(first + i)) {
      numbers[i] = *number;
      ++given;
    }
  }
  if (given == 0) return std::nullopt;
  for (std::size_t i = 0; i < N; ++i) {
    if (!row.has(first + i)) row.fail(first + i, "empty, while other columns of its group are not");
  }
  return numbers;
}

int readCount(const CsvRow& row, std::size_t column, int largest) {
  const std::int64_t number = row.integer(column);
  if (number < 0 || number > largest) row.fail(column, "not in [0, " + std::to_string(largest) + "]");
  return static_cast<int>(number);
}

Detection readDetection(const CsvRow& row, ClassIndex class_index) {
  Detection detection;
  detection.class_index = class_index;
  detection.position_m = {row.anyNumber(kX), row.anyNumber(kY), row.anyNumber(kZ)};
  const std::optional<double> score = row.optionalAnyNumber(kScore);
  if (score != -1.0) detection.score = score;  // unknown, as in messages
  if (const auto s = readGroup<6>(row, kCov)) {
    const auto& [xx, xy, xz, yy, yz, zz] = *s;
    Eigen::Matrix3d cov;
    cov << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    if (!cov.isZero(0.0)) detection.cov_m2 = cov;
  }
  if (const auto size = readGroup<3>(row, kSize)) {
    const Eigen::Vector3d size_m((*size)[0], (*size)[1], (*size)[2]);
    if (!size_m.isZero(0.0)) detection.size_m = size_m;
  }
  if (row.has(kPoints)) detection.points = readCount(row, kPoints, 1 << 30);
  if (row.has(kMoving)) detection.is_moving = readCount(row, kMoving, 1) == 1;
  return detection;
}

/// Which optional columns a file needs.
struct Needed {
  bool score = false;
  bool cov = false;
  bool size = false;
  bool points = false;
  bool moving = false;
};

std::string formatOptional(const Detection& detection, const Needed& needed) {
  std::string text;
  if (needed.score) text += "," + (detection.score ? formatDouble(*detection.score) : "");
  if (needed.cov) {
    for (const auto& [r, c] : {std::pair{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}) {
      text += "," + (detection.cov_m2 ? formatDouble((*detection.cov_m2)(r, c)) : "");
    }
  }
  if (needed.size) {
    for (int i = 0; i < 3; ++i) text += "," + (detection.size_m ? formatFixed((*detection.size_m)[i], 3) : "");
  }
  if (needed.points) text += "," + (detection.points ? std::to_string(*detection.points) : "");
  if (needed.moving) text += detection.is_moving ? ",1" : ",0";
  return text + "\n";
}

}  // namespace

ObjectsFile readObjects(const std::string& path, const ClassTable& classes, std::size_t frames) {
  std::map<std::string, ClassIndex, std::less<>> class_of_name;
  for (int i = 0; i < classes.size(); ++i) class_of_name[classes[i].name] = i;
  ObjectsFile result{std::vector<Detections>(frames), ""};
  result.notice = CsvReader(kRequired, kOptional).read(path, [&](const CsvRow& row) {
    const std::int64_t frame = row.integer(kFrame);
    if (frame < 0 || frame >= static_cast<std::int64_t>(frames)) {
      row.fail(kFrame, "frame " + std::to_string(frame) + " is outside the " + std::to_string(frames) + " frames");
    }
    const auto found = class_of_name.find(row.text(kClass));
    if (found == class_of_name.end()) {
      row.fail(kClass, "unknown class '" + std::string(row.text(kClass)) + "', known are " + classes.names());
    }
    Detections& detections = result.detections[static_cast<std::size_t>(frame)];
    detections.push_back(readDetection(row, found->second));
    detections.back().row = static_cast<int>(detections.size()) - 1;
  });
  return result;
}

std::string formatObjects(const std::vector<Detections>& detections, const ClassTable& classes) {
  Needed needed;
  for (const Detections& frame : detections) {
    for (const Detection& detection : frame) {
      needed.score |= detection.score.has_value();
      needed.cov |= detection.cov_m2.has_value();
      needed.size |= detection.size_m.has_value();
      needed.points |= detection.points.has_value();
      needed.moving |= detection.is_moving;
    }
  }
  std::string text = "frame,class,x,y,z";
  text += needed.score ? ",score" : "";
  text += needed.cov ? ",sxx,sxy,sxz,syy,syz,szz" : "";
  text += needed.size ? ",size_x,size_y,size_z" : "";
  text += needed.points ? ",points" : "";
  text += needed.moving ? ",moving\n" : "\n";
  for (std::size_t frame = 0; frame < detections.size(); ++frame) {
    for (const Detection& detection : detections[frame]) {
      text += std::to_string(frame) + "," + classes[detection.class_index].name;
      for (int i = 0; i < 3; ++i) text += "," + formatFixed(detection.position_m[i], 3);
      text += formatOptional(detection, needed);
    }
  }
  return text;
}

}  // namespace semantic_mht_slam
