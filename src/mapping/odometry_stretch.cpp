#include "semantic_mht_slam/mapping/odometry_stretch.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "semantic_mht_slam/common/dense_solvers.h"

#include "track_equations.h"

namespace semantic_mht_slam {
namespace {

constexpr int kStretchIterations = 4;
constexpr double kLeastErrorVariance = 1e-12;
constexpr double kNoiseFreedom = 10.0;       // residuals that the detector's noise as it is known counts for
constexpr double kMostMeanDeviations = 4.0;  // of the odometry on average; more is a wrong association
constexpr double kMostExcess = 9.0;          // beyond three deviations associations are wrong

/// Variances of the step errors under a model.
Eigen::VectorXd priorVariance(const std::vector<MotionVariance>& steps, bool is_planar) {
  Eigen::VectorXd variance(kPoseNumbers * static_cast<Eigen::Index>(steps.size()));
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const MotionVariance& step = steps[k];
    const auto at = kPoseNumbers * static_cast<Eigen::Index>(k);
    if (is_planar) {
      variance.segment<kPoseNumbers>(at) << step.along_m2, step.across_m2, step.heading_rad2;
    } else {
      variance.segment<kPoseNumbers>(at) << step.up_m2, step.tilt_rad2, step.tilt_rad2;
    }
  }
  return variance.cwiseMax(kLeastErrorVariance);
}

std::vector<MotionVariance> variancesOf(const std::vector<Motion>& motion, const OdometryNoise& noise) {
  std::vector<MotionVariance> result;
  for (const Motion& step : motion) result.push_back(varianceOf(noise, step));
  return result;
}

/// J^T W J with the diagonal W of `weights`. Products are evaluated one by one here: an expression of three takes the
/// compiler seconds.
Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& J, const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd weighted = J.transpose() * weights.asDiagonal();
  return weighted * J;
}

/// Information on the steps' errors e = e0 + E x from that on the poses' errors x around x = 0, where `odometry` is
/// the information of the odometry on e. The detections are as noisy as their residuals are. Empty if they do not fit
/// at all.
StepInformation stepInformation(const Equations& seen, const Eigen::VectorXd& odometry, const Eigen::MatrixXd& E,
                                const Eigen::VectorXd& e0) {
  const Eigen::Index size = e0.size();
  const Eigen::MatrixXd A = inverted(E);
  const Eigen::MatrixXd H = seen.H.topLeftCorner(size, size);
  const Eigen::VectorXd g = seen.g.head(size);
  const Eigen::LDLT<Eigen::MatrixXd> solver(H + normalMatrix(E, odometry));
  const double fitted = Eigen::MatrixXd(solver.solve(H)).trace();  // parameters that the detections decided
  const Eigen::VectorXd weighted_e0 = odometry.cwiseProduct(e0);
  const Eigen::VectorXd gradient = g + E.transpose() * weighted_e0;
  const Eigen::VectorXd x = -solver.solve(gradient);
  const double squares = seen.squares + 2.0 * g.dot(x) + x.dot(H * x);
  const double freedom = std::max(0.0, seen.freedom - fitted);
  const double excess = (squares + kNoiseFreedom) / (freedom + kNoiseFreedom);
  if (!(excess < kMostExcess)) return {};
  StepInformation result;
  const Eigen::MatrixXd At_H = A.transpose() * H;
  const Eigen::MatrixXd At_H_A = At_H * A;
  const Eigen::MatrixXd of_steps = At_H_A / excess;
  result.matrix = 0.5 * (of_steps + of_steps.transpose());
  const Eigen::VectorXd At_g = A.transpose() * g;
  result.vector = result.matrix * e0;
  result.vector -= At_g / excess;
  const Eigen::MatrixXd with_ranges = seen.H.topRightCorner(size, kRangeErrors);
  const Eigen::MatrixXd At_with_ranges = A.transpose() * with_ranges;
  result.coupling = At_with_ranges / excess;
  result.range_matrix = seen.H.bottomRightCorner(kRangeErrors, kRangeErrors) / excess;
  result.range_vector = result.coupling.transpose() * e0;
  result.range_vector -= seen.g.tail(kRangeErrors) / excess;
  if (!result.matrix.allFinite() || !result.vector.allFinite() || !result.coupling.allFinite()) return {};
  return result;
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * M_PI);
}

/// The stretch on the plane: poses (x, y, heading) that start as the odometry's.
class PlanarStretch {
 public:
  PlanarStretch(const OdometryStretch& stretch, const OdometryModel& model)
      : tracks_(tracksOf(stretch)),
        steps_(static_cast<Eigen::Index>(stretch.motion.size())),
        variance_(priorVariance(variancesOf(stretch.motion, model.noise), true)) {
    for (const Pose& T : stretch.T_stretch_base) {
      poses_.emplace_back(T.translation_m.x(), T.translation_m.y(), headingOf(T.rotation));
      tilt_.push_back((expRotation({0.0, 0.0, -poses_.back()[2]}) * T.rotation).normalized().toRotationMatrix());
    }
    for (Eigen::Index k = 0; k < steps_; ++k) odometry_.push_back(step(k));
  }

  bool isEmpty() const { return tracks_.empty() || steps_ == 0; }

  /// False if the steps would have to be far from the odometry's.
  bool solve() {
    for (int i = 0; i < kStretchIterations; ++i) {
      const Equations seen = equationsOf<2>(rows(), kPoseNumbers * steps_);
      const Eigen::MatrixXd E = jacobian();
      const Eigen::VectorXd weights = variance_.cwiseInverse();
      const Eigen::Index size = weights.size();
      const Eigen::MatrixXd H = seen.H.topLeftCorner(size, size) + normalMatrix(E, weights);
      const Eigen::VectorXd weighted_errors = weights.cwiseProduct(errors());
      const Eigen::VectorXd g = seen.g.head(size) + E.transpose() * weighted_errors;
      const auto factor = choleskyOf(H);
      if (!factor) return false;
      const Eigen::VectorXd x = factor->solve(-g);
      if (!x.allFinite()) return false;
      for (Eigen::Index k = 0; k < steps_; ++k) poses_[static_cast<std::size_t>(k) + 1] += x.segment<3>(3 * k);
    }
    const Eigen::VectorXd deviations_sq = errors().cwiseAbs2().cwiseQuotient(variance_);
    return deviations_sq.mean() < kMostMeanDeviations * kMostMeanDeviations;
  }

  StepInformation information() const {
    const Eigen::MatrixXd E = jacobian();
    StepInformation result =
        stepInformation(equationsOf<2>(rows(), kPoseNumbers * steps_), variance_.cwiseInverse(), E, errors());
    if (result.vector.size() == 0) return result;
    result.effect = Eigen::MatrixXd::Zero(kPoseNumbers * steps_, 5);
    for (Eigen::Index k = 0; k < steps_; ++k) {
      const Eigen::Vector3d step = this->step(k);  // the odometry's own has its noise in it
      result.effect.col(0).segment<2>(3 * k) = step.head<2>();
      result.effect(3 * k + 2, 1) = step[2];
      result.effect(3 * k + 2, 2) = step.x();
      result.effect(3 * k + 1, 3) = step.x();
      result.effect(3 * k + 1, 4) = step[2];
    }
    return result;
  }

 private:
  Eigen::Matrix2d turned(std::size_t k) const { return Eigen::Rotation2Dd(poses_[k][2]).toRotationMatrix(); }

  /// From pose k to the next, in the axes of k.
  Eigen::Vector3d step(Eigen::Index k) const {
    const auto i = static_cast<std::size_t>(k);
    Eigen::Vector3d result;
    result.head<2>() = turned(i).transpose() * (poses_[i + 1] - poses_[i]).head<2>();
    result[2] = wrapped(poses_[i + 1][2] - poses_[i][2]);
    return result;
  }

  Eigen::VectorXd errors() const {
    Eigen::VectorXd result(kPoseNumbers * steps_);
    for (Eigen::Index k = 0; k < steps_; ++k) {
      const Eigen::Vector3d error = step(k) - odometry_[static_cast<std::size_t>(k)];
      result.segment<3>(3 * k) << error.head<2>(), wrapped(error[2]);
    }
    return result;
  }

  /// Of the steps' errors by the poses behind the first.
  Eigen::MatrixXd jacobian() const {
    Eigen::MatrixXd E = Eigen::MatrixXd::Zero(kPoseNumbers * steps_, kPoseNumbers * steps_);
    for (Eigen::Index k = 0; k < steps_; ++k) {
      const Eigen::Matrix2d Rt = turned(static_cast<std::size_t>(k)).transpose();
      E.block<2, 2>(3 * k, 3 * k) = Rt;
      E(3 * k + 2, 3 * k + 2) = 1.0;
      if (k == 0) continue;
      const Eigen::Vector3d u = step(k);
      E.block<2, 2>(3 * k, 3 * k - 3) = -Rt;
      E.block<2, 1>(3 * k, 3 * k - 1) << u.y(), -u.x();
      E(3 * k + 2, 3 * k - 1) = -1.0;
    }
    return E;
  }

  Landmarks<2> rows() const {
    Landmarks<2> result;
    for (const auto& track : tracks_) {
      result.emplace_back();
      for (const StretchObservation* seen : track) {
        const auto k = static_cast<std::size_t>(seen->keyframe);
        const Eigen::Matrix3d level = tilt_[k];
        const Eigen::Matrix2d R = turned(k);
        const Eigen::Vector2d lever_m = R * (level * seen->position_m).head<2>();
        const Eigen::Matrix3d cov = level * seen->cov_m2 * level.transpose();
        TrackRow<2> row;
        row.keyframe = seen->keyframe;
        row.point_m = poses_[k].head<2>() + lever_m;
        row.J << 1.0, 0.0, -lever_m.y(), 0.0, 1.0, lever_m.x();
        row.eye_m = poses_[k].head<2>();
        row.information = (R * cov.topLeftCorner<2, 2>() * R.transpose()).inverse();
        result.back().push_back(row);
      }
    }
    return result;
  }

  std::vector<std::vector<const StretchObservation*>> tracks_;
  Eigen::Index steps_;
  Eigen::VectorXd variance_;
  std::vector<Eigen::Vector3d> poses_;
  std::vector<Eigen::Matrix3d> tilt_;  ///< roll and pitch of each, by odometry
  std::vector<Eigen::Vector3d> odometry_;
};

}  // namespace

StepInformation planarInformation(const OdometryStretch& stretch, const OdometryModel& model) {
  PlanarStretch planar(stretch, model);
  if (planar.isEmpty() || !planar.solve()) return {};
  StepInformation result = planar.information();
  result.motion = stretch.motion;
  return result;
}

StepInformation verticalInformation(const OdometryStretch& stretch, const OdometryModel& model) {
  const auto steps = static_cast<Eigen::Index>(stretch.motion.size());
  Landmarks<1> landmarks;
  for (const auto& track : tracksOf(stretch)) {
    landmarks.emplace_back();
    for (const StretchObservation* seen : track) {
      const Pose& T = stretch.T_stretch_base[static_cast<std::size_t>(seen->keyframe)];
      const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
      const Eigen::Vector3d lever_m = R * seen->position_m;
      TrackRow<1> row;
      row.keyframe = seen->keyframe;
      row.point_m << lever_m.z() + T.translation_m.z();
      row.J << 1.0, lever_m.y(), -lever_m.x();
      row.information << 1.0 / R.row(2).dot(seen->cov_m2 * R.row(2).transpose());
      landmarks.back().push_back(row);
    }
  }
  if (landmarks.empty() || steps == 0) return {};
  Eigen::MatrixXd E = Eigen::MatrixXd::Identity(kPoseNumbers * steps, kPoseNumbers * steps);
  for (Eigen::Index k = 1; k < steps; ++k) {
    const Eigen::Vector3d way_m = stretch.T_stretch_base[static_cast<std::size_t>(k) + 1].translation_m -
                                  stretch.T_stretch_base[static_cast<std::size_t>(k)].translation_m;
    E.block<3, 3>(3 * k, 3 * k - 3) = -Eigen::Matrix3d::Identity();
    E.block<1, 2>(3 * k, 3 * k - 2) << -way_m.y(), way_m.x();  // a tilt lifts what is driven next
  }
  const Eigen::VectorXd variance = priorVariance(variancesOf(stretch.motion, model.noise), false);
  StepInformation result = stepInformation(equationsOf<1>(landmarks, kPoseNumbers * steps), variance.cwiseInverse(), E,
                                           Eigen::VectorXd::Zero(kPoseNumbers * steps));
  if (result.vector.size() == 0) return result;
  result.effect = result.coupling = Eigen::MatrixXd::Zero(kPoseNumbers * steps, 0);
  result.range_matrix = Eigen::MatrixXd();
  result.range_vector = Eigen::VectorXd();
  result.motion = stretch.motion;
  return result;
}

}  // namespace semantic_mht_slam
