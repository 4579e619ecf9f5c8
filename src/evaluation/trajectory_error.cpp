#include "semantic_mht_slam/evaluation/trajectory_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "semantic_mht_slam/evaluation/planar_grid.h"
#include "semantic_mht_slam/evaluation/revisit.h"
#include "semantic_mht_slam/evaluation/statistics.h"

namespace semantic_mht_slam {
namespace {

using Trajectory = std::vector<PoseMatrix>;

constexpr double kRadToDeg = 57.29577951308232;
constexpr std::size_t kStretchStride = 10;  // the stretches begin at every tenth frame
constexpr std::array<double, 8> kStretchLengths_m = {100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0};
constexpr std::size_t kRevisitStride = 5;
constexpr std::size_t kMaxRevisits = std::size_t{1} << 24;

void requireComparable(const Trajectory& truth, const Trajectory& estimate) {
  if (truth.empty()) throw std::invalid_argument("the true trajectory has no poses");
  if (truth.size() != estimate.size()) {
    throw std::invalid_argument(std::to_string(estimate.size()) + " poses against " + std::to_string(truth.size()) +
                                " in the truth");
  }
  const auto finite = [](const PoseMatrix& pose) { return pose.matrix().allFinite(); };
  if (!std::all_of(truth.begin(), truth.end(), finite) || !std::all_of(estimate.begin(), estimate.end(), finite)) {
    throw std::invalid_argument("a trajectory has values that are not finite");
  }
}

std::vector<Eigen::Vector3d> positions(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(trajectory.size());
  for (const PoseMatrix& pose : trajectory) result.emplace_back(pose.translation());
  return result;
}

/// Path length from the first pose to each.
std::vector<double> travelled(const Trajectory& trajectory) {
  std::vector<double> length_m(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length_m[i] = length_m[i - 1] + (trajectory[i].translation() - trajectory[i - 1].translation()).norm();
  }
  return length_m;
}

/// Translation and rotation error over stretches of fixed length; the stretches are measured on the truth.
void addRelativeErrors(const Trajectory& truth, const Trajectory& estimate, TrajectoryError& error) {
  const std::vector<double> travelled_m = travelled(truth);
  std::vector<double> translation_percent;
  std::vector<double> rotation_deg_per_100m;
  for (std::size_t first = 0; first < truth.size(); first += kStretchStride) {
    for (const double length_m : kStretchLengths_m) {
      const auto end = std::lower_bound(travelled_m.begin(), travelled_m.end(), travelled_m[first] + length_m);
      if (end == travelled_m.end()) break;
      const auto last = static_cast<std::size_t>(end - travelled_m.begin());
      const PoseMatrix true_motion = truth[first].inverse() * truth[last];
      const PoseMatrix difference = (estimate[first].inverse() * estimate[last]).inverse() * true_motion;
      const double cosine = std::clamp(0.5 * (difference.linear().trace() - 1.0), -1.0, 1.0);
      translation_percent.push_back(100.0 * difference.translation().norm() / length_m);
      rotation_deg_per_100m.push_back(100.0 * kRadToDeg * std::acos(cosine) / length_m);
    }
  }
  error.t_rel_percent = mean(translation_percent);
  error.r_rel_deg_per_100m = mean(rotation_deg_per_100m);
}

/// A list that halves itself, keeping every second value, when it is full: a robot that stands still for an hour sees
/// its place again in some hundred million pairs of frames.
class ThinnedList {
 public:
  void add(double value) {
    if (count_++ % stride_ != 0) return;
    values_.push_back(value);
    if (values_.size() < kMaxRevisits) return;
    for (std::size_t i = 0; 2 * i < values_.size(); ++i) values_[i] = values_[2 * i];
    values_.resize((values_.size() + 1) / 2);
    stride_ *= 2;
  }
  std::vector<double>& values() { return values_; }

 private:
  std::vector<double> values_;
  std::size_t count_ = 0;
  std::size_t stride_ = 1;
};

/// Coordinates along the two axes in which the drive extends farthest: the ground plane, whichever way the axes point.
std::vector<Eigen::Vector2d> planar(const Trajectory& trajectory) {
  Eigen::AlignedBox3d box;
  for (const PoseMatrix& pose : trajectory) box.extend(Eigen::Vector3d(pose.translation()));
  std::array<int, 3> axes = {0, 1, 2};
  const Eigen::Vector3d extent_m = box.sizes();
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return extent_m(a) > extent_m(b); });
  std::vector<Eigen::Vector2d> result;
  result.reserve(trajectory.size());
  for (const PoseMatrix& pose : trajectory) {
    result.emplace_back(pose.translation()(axes[0]), pose.translation()(axes[1]));
  }
  return result;
}

double revisitError(const Trajectory& truth, const Trajectory& estimate) {
  const std::vector<Eigen::Vector2d> points_m = planar(truth);
  const PlanarGrid grid(points_m, kRevisitRadius_m);
  ThinnedList errors_m;
  for (std::size_t i = 0; i < truth.size(); i += kRevisitStride) {
    grid.anyNear(points_m[i], [&](std::size_t j) {
      const Eigen::Vector3d true_step_m = truth[i].translation() - truth[j].translation();
      if (i <= j + kRevisitMinFrames || true_step_m.norm() > kRevisitRadius_m) return false;
      const Eigen::Vector3d step_m = estimate[i].translation() - estimate[j].translation();
      errors_m.add((truth[j].linear().inverse() * true_step_m - estimate[j].linear().inverse() * step_m).norm());
      return false;
    });
  }
  return median(errors_m.values());
}

}  // namespace

TrajectoryError trajectoryError(const std::vector<Pose>& truth, const std::vector<Pose>& estimate) {
  return trajectoryError(poseMatrices(truth), poseMatrices(estimate));
}

TrajectoryError trajectoryError(const Trajectory& truth, const Trajectory& estimate) {
  const FrameErrors frames = frameErrors(truth, estimate);
  TrajectoryError error;
  error.first_m = rootMeanSquare(frames.unaligned_m);
  error.se3_m = rootMeanSquare(frames.aligned_m);
  error.running_mean_m = mean(frames.running_rmse_m);
  error.running_std_m = standardDeviation(frames.running_rmse_m);
  error.end_m = frames.unaligned_m.back();
  addRelativeErrors(truth, estimate, error);
  error.revisit_m = revisitError(truth, estimate);
  return error;
}

FrameErrors frameErrors(const Trajectory& truth, const Trajectory& estimate) {
  requireComparable(truth, estimate);
  const Trajectory moved = startingAt(truth.front(), estimate);
  const Pose alignment = rigidAlignment(positions(estimate), positions(truth));
  FrameErrors errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector3d true_position_m = truth[i].translation();
    errors.unaligned_m.push_back((moved[i].translation() - true_position_m).norm());
    errors.aligned_m.push_back((alignment * Eigen::Vector3d(estimate[i].translation()) - true_position_m).norm());
  }
  errors.running_rmse_m = runningRmse(errors.unaligned_m);
  return errors;
}

Trajectory startingAt(const PoseMatrix& first, const Trajectory& trajectory) {
  if (trajectory.empty()) return {};
  const PoseMatrix motion = first * trajectory.front().inverse();
  Trajectory moved;
  moved.reserve(trajectory.size());
  for (const PoseMatrix& pose : trajectory) moved.push_back(motion * pose);
  return moved;
}

std::vector<double> runningRmse(const std::vector<double>& errors_m) {
  std::vector<double> result;
  result.reserve(errors_m.size());
  double sum_m2 = 0.0;
  for (const double error_m : errors_m) {
    sum_m2 += error_m * error_m;
    result.push_back(std::sqrt(sum_m2 / static_cast<double>(result.size() + 1)));
  }
  return result;
}

double pathLength(const Trajectory& trajectory) {
  return trajectory.empty() ? 0.0 : travelled(trajectory).back();
}

std::vector<PoseMatrix> poseMatrices(const std::vector<Pose>& poses) {
  Trajectory result;
  result.reserve(poses.size());
  for (const Pose& pose : poses) {
    PoseMatrix matrix = PoseMatrix::Identity();
    matrix.linear() = pose.rotation.toRotationMatrix();
    matrix.translation() = pose.translation_m;
    result.push_back(matrix);
  }
  return result;
}

std::vector<std::pair<std::string, double>> namedFigures(const TrajectoryError& error) {
  return {{"first_m", error.first_m},
          {"se3_m", error.se3_m},
          {"running_mean_m", error.running_mean_m},
          {"running_std_m", error.running_std_m},
          {"t_rel_percent", error.t_rel_percent},
          {"r_rel_deg_per_100m", error.r_rel_deg_per_100m},
          {"revisit_m", error.revisit_m},
          {"end_m", error.end_m}};
}

}  // namespace semantic_mht_slam
