#include "semantic_mht_slam/io/calibration_file.h"

#include <cmath>
#include <optional>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

constexpr std::string_view kKey = "Tr:";

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The numbers after a key, into a matrix of as many.
template <class Matrix>
Matrix parseMatrix(const std::string& where, std::string_view key, std::string_view text) {
  Matrix matrix;
  const std::vector<std::string_view> cells = splitBlanks(text);
  if (static_cast<Eigen::Index>(cells.size()) != matrix.size()) {
    throw InputError(where + ": " + std::to_string(cells.size()) + " numbers after " + std::string(key) + ", not " +
                     std::to_string(matrix.size()));
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::optional<double> value = parseDouble(cells[i]);
    if (!value || !std::isfinite(*value)) {
      throw InputError(where + ": '" + std::string(cells[i]) + "' is not a finite number");
    }
    matrix.data()[i] = *value;
  }
  return matrix;
}

void requireRotation(const std::string& where, std::string_view key, const Eigen::Matrix3d& rotation) {
  const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 0.01 || rotation.determinant() < 0.0) {
    throw InputError(where + ": the 3x3 part of " + std::string(key) + " is no rotation");
  }
}

enum class Kind { kProjection, kRotation };

/// The matrix of the last line that begins with `key`; empty if there is none.
template <class Matrix>
std::optional<Matrix> findMatrix(const std::string& path, const std::string& content, std::string_view key, Kind kind) {
  std::optional<Matrix> matrix;
  forEachLine(content, [&](int line, std::string_view text) {
    if (text.substr(0, key.size()) != key) return;
    matrix = parseMatrix<Matrix>(at(path, line), key, text.substr(key.size()));
    if (kind == Kind::kRotation) requireRotation(at(path, line), key, matrix->template leftCols<3>());
  });
  return matrix;
}

std::optional<Pose> findTransform(const std::string& path, const std::string& content, std::string_view key) {
  const std::optional<Matrix34> matrix = findMatrix<Matrix34>(path, content, key, Kind::kRotation);
  return matrix ? std::optional(Pose::fromMatrix(*matrix)) : std::nullopt;
}

}  // namespace

Pose readCalibration(const std::string& path) {
  const std::optional<Pose> T_cam0_velodyne = findTransform(path, readFile(path), kKey);
  if (!T_cam0_velodyne) throw InputError(path + ": no line begins with Tr: (transform from Velodyne to camera 0)");
  return *T_cam0_velodyne;
}

Camera readCamera(const std::string& path) {
  const std::string content = readFile(path);
  const std::optional<Matrix34> projection = findMatrix<Matrix34>(path, content, "P2:", Kind::kProjection);
  if (!projection) throw InputError(path + ": no line begins with P2: (projection of the left colour camera)");
  std::optional<Pose> T_cam0_velodyne = findTransform(path, content, "Tr_velo_to_cam:");
  if (!T_cam0_velodyne) T_cam0_velodyne = findTransform(path, content, kKey);
  if (!T_cam0_velodyne) throw InputError(path + ": no line begins with Tr: or Tr_velo_to_cam:");
  Pose rectification;
  if (const std::optional<Matrix3> matrix = findMatrix<Matrix3>(path, content, "R0_rect:", Kind::kRotation)) {
    rectification.rotation = Eigen::Quaterniond(Eigen::Matrix3d(*matrix)).normalized();
  }
  return {*projection, rectification * *T_cam0_velodyne};
}

std::string formatCalibration(const Pose& T_cam0_velodyne) {
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix = T_cam0_velodyne.matrix();
  std::string text(kKey);
  for (Eigen::Index i = 0; i < matrix.size(); ++i) text += " " + formatDouble(matrix.data()[i]);
  return text + "\n";
}

}  // namespace semantic_mht_slam
