#include "bias_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "semantic_mht_slam/common/dense_solvers.h"

namespace semantic_mht_slam {
namespace {

constexpr int kRobustPasses = 2;
constexpr double kCauchySigma = 2.0;
constexpr int kPoseSize = 4;  // x, y, z, heading
constexpr int kEntries = 8;   // two knots of the range bias, two of the height bias, pose
constexpr int kPoseEntry = kEntries - kPoseSize;
constexpr double kLeastBiasRange_m = 1.0;
constexpr double kGaugeStddev = 1e-3;
constexpr double kLeastStepVariance = 1e-10;

/// An equation: landmark = point + J x, with the weight of its 3x3 information. Unknowns by rising index.
struct BiasRow {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  std::array<int, kEntries> index{};
  std::array<int, kEntries> place{};  ///< of the unknowns among those of the landmark
  Eigen::Matrix<double, 3, kEntries> J = Eigen::Matrix<double, 3, kEntries>::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  double weight = 1.0;
};

/// All that show one landmark.
struct LandmarkRows {
  std::vector<BiasRow> rows;
  std::vector<int> unknowns;  ///< by rising index, without the many that the landmark has nothing to do with
};

/// Equations in unknowns x: the coefficients first, then scale, direction and slope of this stretch, then the error of
/// each keyframe's pose. Of matrices, which are symmetric, only the lower triangle is filled.
class StretchEquations {
 public:
  StretchEquations(const BiasStretch& stretch, const BiasLayout& layout, const BiasMotionNoise& noise)
      : stretch_(stretch), layout_(layout), noise_(noise) {
    size_ = layout.size() + BiasLayout::kMotion + kPoseSize * static_cast<int>(stretch.T_stretch_base.size());
    collectRows();
  }

  bool isEmpty() const { return landmarks_.empty(); }

  /// Weighs the rows by their residuals under the best solution so far. False if numbers too far apart leave none.
  bool reweigh(const BiasInformation& prior) {
    BiasInformation all = normalEquations();
    all.matrix.topLeftCorner(layout_.size(), layout_.size()) += prior.matrix;
    all.vector.head(layout_.size()) += prior.vector;
    const auto factor = choleskyOf(all.matrix);
    if (!factor) return false;
    const Eigen::VectorXd x = factor->solve(all.vector);
    for (LandmarkRows& landmark : landmarks_) reweigh(landmark.rows, x);
    return true;
  }

  /// What is known of the coefficients without any prior on them.
  BiasInformation marginal() const { return semantic_mht_slam::marginal(normalEquations(), layout_.size()); }

 private:
  int motion(int i) const { return layout_.size() + i; }
  int pose(int keyframe) const { return layout_.size() + BiasLayout::kMotion + kPoseSize * keyframe; }

  void collectRows() {
    std::map<LandmarkId, std::vector<const BiasObservation*>> by_landmark;
    for (const BiasObservation& observation : stretch_.observations) {
      by_landmark[observation.landmark].push_back(&observation);
    }
    for (const auto& [id, observations] : by_landmark) {
      if (static_cast<int>(observations.size()) < noise_.min_observations) continue;
      const Eigen::Vector3d landmark_m = medianPosition(observations);
      std::vector<BiasRow>& rows = landmarks_.emplace_back().rows;
      for (const BiasObservation* observation : observations) rows.push_back(row(*observation, landmark_m));
      noteUnknowns(landmarks_.back());
    }
  }

  Eigen::Vector3d medianPosition(const std::vector<const BiasObservation*>& observations) const {
    Eigen::Vector3d result;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const BiasObservation* observation : observations) {
        const Pose& T = stretch_.T_stretch_base[static_cast<std::size_t>(observation->keyframe)];
        values.push_back((T * observation->position_m)[axis]);
      }
      std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
      result[axis] = values[values.size() / 2];
    }
    return result;
  }

  /// Range and line of sight are those to the landmark: were they the detection's own, its noise would be in both sides
  /// of the equation, and a bias that grows with the range would make it smaller.
  BiasRow row(const BiasObservation& observation, const Eigen::Vector3d& landmark_m) const {
    const Pose& T = stretch_.T_stretch_base[static_cast<std::size_t>(observation.keyframe)];
    const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
    const Eigen::Vector3d lever_m = R * observation.position_m;
    const Eigen::Vector3d ray_m = landmark_m - T.translation_m;
    const double range_m = std::max(ray_m.norm(), kLeastBiasRange_m);
    const Eigen::Vector3d sight = ray_m / range_m;
    BiasRow result;
    result.point_m = lever_m + T.translation_m;
    result.information = (R * observation.cov_m2 * R.transpose()).inverse();
    for (int i = 0; i < kPoseSize; ++i) result.index[kPoseEntry + i] = pose(observation.keyframe) + i;
    result.J.middleCols<3>(kPoseEntry).setIdentity();
    result.J.col(kPoseEntry + 3) << -lever_m.y(), lever_m.x(), 0.0;
    const BiasBasis basis = biasBasis(range_m);
    for (int k = 0; k < 2; ++k) {
      const int knot = std::min(basis.knot + k, BiasLayout::kRangeKnots - 1);
      const double share = k == 0 ? basis.near_share : basis.far_share;
      result.index[k] = layout_.range(observation.class_index, knot);
      result.J.col(k) = -share * sight;
      result.index[2 + k] = layout_.height(observation.class_index, std::max(knot, 1));
      if (knot > 0) result.J.col(2 + k) = -share * R.col(2);
    }
    return result;
  }

  BiasInformation normalEquations() const {
    BiasInformation all{Eigen::MatrixXd::Zero(size_, size_), Eigen::VectorXd::Zero(size_)};
    for (const LandmarkRows& landmark : landmarks_) addLandmark(landmark, all);
    addMotion(all);
    return all;
  }

  static void noteUnknowns(LandmarkRows& landmark) {
    std::vector<int>& unknowns = landmark.unknowns;
    for (const BiasRow& row : landmark.rows) unknowns.insert(unknowns.end(), row.index.begin(), row.index.end());
    std::sort(unknowns.begin(), unknowns.end());
    unknowns.erase(std::unique(unknowns.begin(), unknowns.end()), unknowns.end());
    for (BiasRow& row : landmark.rows) {
      for (std::size_t a = 0; a < kEntries; ++a) {
        const auto found = std::lower_bound(unknowns.begin(), unknowns.end(), row.index[a]);
        row.place[a] = static_cast<int>(found - unknowns.begin());
      }
    }
  }

  /// The equations of one landmark, its position eliminated.
  void addLandmark(const LandmarkRows& landmark, BiasInformation& all) const {
    Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto& [rows, used] = landmark;
    const auto count = static_cast<Eigen::Index>(used.size());
    Eigen::Matrix<double, Eigen::Dynamic, 3> cross = Eigen::MatrixXd::Zero(count, 3);
    const Eigen::Vector3d origin_m = rows.front().point_m;  // keeps the numbers small
    for (const BiasRow& row : rows) {
      const Eigen::Matrix3d W = row.weight * row.information;
      const Eigen::Matrix<double, kEntries, 3> JtW = row.J.transpose() * W;
      const Eigen::Matrix<double, kEntries, kEntries> JtWJ = JtW * row.J;
      const Eigen::Vector3d d = row.point_m - origin_m;
      const Eigen::Matrix<double, kEntries, 1> JtWd = JtW * d;
      for (int a = 0; a < kEntries; ++a) {
        cross.row(row.place[a]) += JtW.row(a);
        all.vector[row.index[a]] -= JtWd[a];
        for (int b = 0; b <= a; ++b) all.matrix(row.index[a], row.index[b]) += JtWJ(a, b);
      }
      total += W;
      sum += W * d;
    }
    const Eigen::Matrix<double, Eigen::Dynamic, 3> weighted = cross * total.inverse();
    Eigen::VectorXd eliminated(count);
    for (Eigen::Index b = 0; b < count; ++b) {
      eliminated.tail(count - b) = weighted.bottomRows(count - b).lazyProduct(cross.row(b).transpose());
      for (Eigen::Index a = b; a < count; ++a) all.matrix(used[a], used[b]) -= eliminated[a];
      all.vector[used[b]] += weighted.row(b).dot(sum);
    }
  }

  /// Random walk of the pose's error; scale, direction and slope act on every step.
  void addMotion(BiasInformation& all) const {
    for (int i = 0; i < BiasLayout::kMotion; ++i) {
      all.matrix(motion(i), motion(i)) += 1.0 / (noise_.scale_change_stddev * noise_.scale_change_stddev);
    }
    for (int i = 0; i < kPoseSize; ++i) all.matrix(pose(0) + i, pose(0) + i) += 1.0 / (kGaugeStddev * kGaugeStddev);
    for (std::size_t k = 0; k + 1 < stretch_.T_stretch_base.size(); ++k) addStep(static_cast<int>(k), all);
  }

  void addStep(int k, BiasInformation& all) const {
    const Eigen::Vector3d step = stretch_.T_stretch_base[static_cast<std::size_t>(k) + 1].translation_m -
                                 stretch_.T_stretch_base[static_cast<std::size_t>(k)].translation_m;
    const double distance_m = std::max(step.norm(), 0.1);
    constexpr int kColumns = 2 * kPoseSize + 2 * BiasLayout::kMotion;
    std::array<int, kColumns> index{};
    Eigen::Matrix<double, kPoseSize, kColumns> J = Eigen::Matrix<double, kPoseSize, kColumns>::Zero();
    for (int i = 0; i < kPoseSize; ++i) {
      index[i] = pose(k) + i;
      index[kPoseSize + i] = pose(k + 1) + i;
      J(i, i) = -1.0;
      J(i, kPoseSize + i) = 1.0;
    }
    J(0, 3) = step.y();  // an error of the heading turns what is driven next
    J(1, 3) = -step.x();
    for (int shared = 0; shared < 2; ++shared) {
      const int first = 2 * kPoseSize + shared * BiasLayout::kMotion;
      for (int i = 0; i < BiasLayout::kMotion; ++i) index[first + i] = shared == 1 ? layout_.motion(i) : motion(i);
      J.col(first).head<3>() = -step;
      J.col(first + 1).head<2>() << step.y(), -step.x();
      J(2, first + 2) = -distance_m;
    }
    const Eigen::Vector4d information = stepVariance(k, distance_m).cwiseMax(kLeastStepVariance).cwiseInverse();
    const Eigen::Matrix<double, kColumns, kColumns> JtWJ = J.transpose() * information.asDiagonal() * J;
    for (int a = 0; a < kColumns; ++a) {
      for (int b = 0; b < kColumns; ++b) {
        if (index[a] >= index[b]) all.matrix(index[a], index[b]) += JtWJ(a, b);
      }
    }
  }

  /// Of x, y, z and heading.
  Eigen::Vector4d stepVariance(int k, double distance_m) const {
    const Pose& from = stretch_.T_stretch_base[static_cast<std::size_t>(k)];
    const Pose& to = stretch_.T_stretch_base[static_cast<std::size_t>(k) + 1];
    const double turn_rad = motionOf(from.inverse() * to).turn_rad;
    const MotionVariance variance = varianceOf(noise_.odometry, {distance_m, turn_rad});
    const double planar_m2 = std::max(variance.along_m2, variance.across_m2);
    return {planar_m2, planar_m2, variance.up_m2, variance.heading_rad2};
  }

  static void reweigh(std::vector<BiasRow>& rows, const Eigen::VectorXd& x) {
    std::vector<Eigen::Vector3d> points_m;
    Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const BiasRow& row : rows) {
      Eigen::Vector3d point_m = row.point_m;
      for (int a = 0; a < kEntries; ++a) point_m += row.J.col(a) * x[row.index[a]];
      total += row.weight * row.information;
      sum += row.weight * row.information * point_m;
      points_m.push_back(point_m);
    }
    const Eigen::Vector3d landmark_m = total.inverse() * sum;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::Vector3d d = points_m[i] - landmark_m;
      const double deviations_sq = d.dot(rows[i].information * d) / 3.0;
      rows[i].weight = 1.0 / (1.0 + deviations_sq / (kCauchySigma * kCauchySigma));
    }
  }

  const BiasStretch& stretch_;
  const BiasLayout& layout_;
  const BiasMotionNoise& noise_;
  int size_ = 0;
  std::vector<LandmarkRows> landmarks_;
};

}  // namespace

BiasBasis biasBasis(double range_m) {
  const auto& knots = BiasLayout::kKnots_m;
  int knot = 0;
  while (knot + 2 < BiasLayout::kRangeKnots && range_m > knots[static_cast<std::size_t>(knot) + 1]) ++knot;
  const auto k = static_cast<std::size_t>(knot);
  const double far_share = (range_m - knots[k]) / (knots[k + 1] - knots[k]);
  return {knot, 1.0 - far_share, far_share};
}

BiasInformation marginal(const BiasInformation& all, int count) {
  const Eigen::Index n = all.vector.size() - count;
  BiasInformation result{all.matrix.topLeftCorner(count, count), all.vector.head(count)};
  const Eigen::LLT<Eigen::MatrixXd> factor(all.matrix.bottomRightCorner(n, n));
  if (factor.info() != Eigen::Success) result.vector.setConstant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::MatrixXd whitened = factor.matrixL().solve(all.matrix.bottomLeftCorner(n, count));
  result.matrix.selfadjointView<Eigen::Lower>().rankUpdate(whitened.transpose(), -1.0);
  result.matrix.triangularView<Eigen::StrictlyUpper>() = result.matrix.transpose();
  result.vector -= whitened.transpose() * factor.matrixL().solve(all.vector.tail(n));
  return result;
}

BiasInformation biasInformation(const BiasStretch& stretch, const BiasLayout& layout, const BiasMotionNoise& noise,
                                const BiasInformation& prior) {
  const BiasInformation none{Eigen::MatrixXd::Zero(layout.size(), layout.size()), Eigen::VectorXd::Zero(layout.size())};
  StretchEquations equations(stretch, layout, noise);
  if (equations.isEmpty()) return none;
  for (int pass = 0; pass < kRobustPasses; ++pass) {
    if (!equations.reweigh(prior)) return none;
  }
  return equations.marginal();
}

}  // namespace semantic_mht_slam
