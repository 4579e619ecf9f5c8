#include "semantic_mht_slam/io/trajectory_file.h"

#include <array>
#include <cmath>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

template <std::size_t N>
std::array<double, N> readNumbers(const std::string& path, int line, std::string_view text) {
  const std::vector<std::string_view> cells = splitBlanks(text);
  if (cells.size() != N) {
    throw InputError(at(path, line) + ": " + std::to_string(cells.size()) + " numbers, " + std::to_string(N) +
                     " were expected");
  }
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::optional<double> value = parseDouble(cells[i]);
    if (!value || !std::isfinite(*value)) {
      throw InputError(at(path, line) + ": '" + std::string(cells[i]) + "' (number " + std::to_string(i + 1) +
                       ") is not a finite number");
    }
    numbers[i] = *value;
  }
  return numbers;
}

constexpr double kLatestSeconds = 4e9;  // ROS time ends at 2^32 s
constexpr double kFurthest_m = 1e7;     // a quarter of the way round the Earth

Stamp readStamp(const std::string& where, double seconds) {
  if (!(seconds >= 0.0 && seconds <= kLatestSeconds)) {
    throw InputError(where + ": time " + formatDouble(seconds) + " s is outside 0 to 4e9 s");
  }
  return stampFromSeconds(seconds);
}

void requireNear(const std::string& where, const Eigen::Vector3d& position_m) {
  if (position_m.cwiseAbs().maxCoeff() > kFurthest_m) throw InputError(where + ": a position beyond 1e7 m");
}

Pose poseFromRow(const std::array<double, 12>& row, const std::string& where) {
  const Eigen::Matrix<double, 3, 4> matrix = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(row.data());
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 0.01 || rotation.determinant() < 0.0) throw InputError(where + ": the 3x3 part is no rotation");
  requireNear(where, matrix.col(3));
  return Pose::fromMatrix(matrix);
}

void requireRising(const std::string& where, Stamp previous, Stamp stamp) {
  if (stamp <= previous) {
    throw InputError(where + ": stamp " + formatFixed(secondsFromStamp(stamp), 9) + " s does not come after " +
                     formatFixed(secondsFromStamp(previous), 9) + " s");
  }
}

void requireRows(const std::string& path, std::size_t rows) {
  if (rows == 0) throw InputError(path + ": empty");
}

std::string formatRow(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : " ") + formatDouble(number);
  return text + "\n";
}

std::string formatSeconds(Stamp stamp) {
  const std::string fraction = std::to_string(1000000000 + stamp % 1000000000).substr(1);
  return std::to_string(stamp / 1000000000) + "." + fraction;
}

}  // namespace

std::vector<Pose> readKittiTrajectory(const std::string& path) {
  std::vector<Pose> poses;
  forEachLine(readFile(path), [&](int line, std::string_view text) {
    poses.push_back(poseFromRow(readNumbers<12>(path, line, text), at(path, line)));
  });
  requireRows(path, poses.size());
  return poses;
}

std::string formatKittiTrajectory(const std::vector<Pose>& T_world_cam0) {
  std::string text;
  for (const Pose& pose : T_world_cam0) {
    const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix = pose.matrix();
    text += formatRow({matrix.data(), matrix.data() + matrix.size()});
  }
  return text;
}

std::vector<StampedPose> readTumTrajectory(const std::string& path) {
  std::vector<StampedPose> trajectory;
  forEachLine(readFile(path), [&](int line, std::string_view text) {
    const std::array<double, 8> row = readNumbers<8>(path, line, text);
    const Eigen::Quaterniond rotation(row[7], row[4], row[5], row[6]);
    if (std::abs(rotation.norm() - 1.0) > 0.01) throw InputError(at(path, line) + ": the quaternion has no unit norm");
    const Stamp stamp = readStamp(at(path, line), row[0]);
    requireNear(at(path, line), {row[1], row[2], row[3]});
    if (!trajectory.empty()) requireRising(at(path, line), trajectory.back().stamp, stamp);
    trajectory.push_back({stamp, normalized({rotation, {row[1], row[2], row[3]}})});
  });
  requireRows(path, trajectory.size());
  return trajectory;
}

std::string formatTumTrajectory(const std::vector<StampedPose>& trajectory) {
  std::string text;
  for (const auto& [stamp, pose] : trajectory) {
    const Eigen::Vector3d& t = pose.translation_m;
    const Eigen::Quaterniond& q = pose.rotation;
    text += formatSeconds(stamp) + " " + formatRow({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
  }
  return text;
}

std::vector<Stamp> readTimes(const std::string& path) {
  std::vector<Stamp> stamps;
  forEachLine(readFile(path), [&](int line, std::string_view text) {
    const Stamp stamp = readStamp(at(path, line), readNumbers<1>(path, line, text)[0]);
    if (!stamps.empty()) requireRising(at(path, line), stamps.back(), stamp);
    stamps.push_back(stamp);
  });
  requireRows(path, stamps.size());
  return stamps;
}

std::string formatTimes(const std::vector<Stamp>& stamps) {
  std::string text;
  for (const Stamp stamp : stamps) text += formatSeconds(stamp) + "\n";
  return text;
}

}  // namespace semantic_mht_slam
