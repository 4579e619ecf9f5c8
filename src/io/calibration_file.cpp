#include "semantic_mht_slam/io/calibration_file.h"

#include <cmath>
#include <optional>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

constexpr std::string_view kKey = "Tr:";

Pose parseTransform(const std::string& where, std::string_view text) {
  const std::vector<std::string_view> cells = splitBlanks(text);
  if (cells.size() != 12) throw InputError(where + ": " + std::to_string(cells.size()) + " numbers after Tr:, not 12");
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::optional<double> value = parseDouble(cells[i]);
    if (!value || !std::isfinite(*value)) {
      throw InputError(where + ": '" + std::string(cells[i]) + "' is not a finite number");
    }
    matrix.data()[i] = *value;
  }
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 0.01 || rotation.determinant() < 0.0) throw InputError(where + ": the 3x3 part of Tr: is no rotation");
  return Pose::fromMatrix(matrix);
}

}  // namespace

Pose readCalibration(const std::string& path) {
  std::optional<Pose> T_cam0_velodyne;
  forEachLine(readFile(path), [&](int line, std::string_view text) {
    if (text.substr(0, kKey.size()) == kKey) T_cam0_velodyne = parseTransform(at(path, line), text.substr(kKey.size()));
  });
  if (!T_cam0_velodyne) throw InputError(path + ": no line begins with Tr: (transform from Velodyne to camera 0)");
  return *T_cam0_velodyne;
}

std::string formatCalibration(const Pose& T_cam0_velodyne) {
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix = T_cam0_velodyne.matrix();
  std::string text(kKey);
  for (Eigen::Index i = 0; i < matrix.size(); ++i) text += " " + formatDouble(matrix.data()[i]);
  return text + "\n";
}

}  // namespace semantic_mht_slam
