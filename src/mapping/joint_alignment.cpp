#include "semantic_mht_slam/mapping/joint_alignment.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "alignment_problem.h"
#include "alignment_refinement.h"
#include "alignment_votes.h"

namespace semantic_mht_slam {
namespace {

bool isSame(const AlignmentState& a, const AlignmentState& b, const JointAlignmentConfig& config) {
  return (a - b).head<2>().norm() < config.distinct_m && std::abs(a(3) - b(3)) < config.distinct_rad;
}

/// Adds a mode unless it is there; of two that are the same, the likelier stays.
void addMode(std::vector<AlignmentMode>& modes, AlignmentMode mode, const JointAlignmentConfig& config) {
  for (AlignmentMode& known : modes) {
    if (!isSame(known.state, mode.state, config)) continue;
    if (mode.log_evidence > known.log_evidence) known = std::move(mode);
    return;
  }
  modes.push_back(std::move(mode));
}

std::vector<AlignmentMode> findModes(const AlignmentProblem& problem, const JointAlignmentConfig& config) {
  std::vector<AlignmentMode> modes;
  AlignmentRefinement refinement(problem, config);
  for (const AlignmentState& seed : alignmentSeeds(problem, config)) {
    std::optional<AlignmentMode> mode = refinement.refine(seed);
    if (mode && mode->log_evidence > 0.0) addMode(modes, std::move(*mode), config);
  }
  std::sort(modes.begin(), modes.end(),
            [](const AlignmentMode& a, const AlignmentMode& b) { return a.log_evidence > b.log_evidence; });
  std::size_t kept = 0;
  while (kept < modes.size() && static_cast<int>(kept) < config.max_hypotheses &&
         modes[kept].log_evidence > modes.front().log_evidence - config.max_log_ratio) {
    ++kept;
  }
  modes.resize(kept);
  return modes;
}

AlignmentHypothesis hypothesis(const AlignmentMode& mode, const AlignmentProblem& problem, const Pose& prior_T_a_b) {
  const Eigen::Matrix3d R_a_level = headingRotation(problem.prior_heading_rad);
  AlignmentHypothesis result;
  result.T_a_b.rotation = (Eigen::Quaterniond(headingRotation(mode.state(3))) * prior_T_a_b.rotation).normalized();
  result.T_a_b.translation_m = prior_T_a_b.translation_m + R_a_level * mode.state.head<3>();
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.topLeftCorner<3, 3>() = R_a_level;
  result.cov = turn * mode.cov * turn.transpose();
  result.log_likelihood = mode.log_evidence;
  result.landmark_for_detection.assign(problem.detections.size(), -1);
  for (const AlignmentMatch& match : mode.matches) {
    result.landmark_for_detection[problem.detections[match.detection].index] = problem.landmarks[match.landmark].index;
    result.soft_inliers += 1.0 / (1.0 + std::exp(-match.log_odds));
  }
  return result;
}

}  // namespace

void describe(JointAlignmentConfig& config, Fields& fields) {
  fields.add("window_sigmas", config.window_sigmas, "", {0.5, 6.0},
             "Offsets are looked for within so many deviations of the prior.");
  fields.add("max_window", config.max_window_m, "m", {1.0, 200.0},
             "But not beyond this shift; bounds time and memory.");
  fields.add("cell", config.cell_m, "m", {0.05, 5.0}, "Side of a cell of the voting grid.");
  fields.add("yaw_step", config.yaw_step_rad, "rad", {0.001, 0.2}, "Heading step of the voting grid.");
  fields.add("max_seeds", config.max_seeds, "", {1, 1000}, "Peaks of the voting grid that are refined.");
  fields.add("max_hypotheses", config.max_hypotheses, "", {1, 100}, "Most alignments returned.");
  fields.add("max_log_ratio", config.max_log_ratio, "", {0.0, 1e6},
             "Alignments less likely than the best by more than this log ratio are left out.");
  fields.add("min_matches", config.min_matches, "", {2, 1000}, "Fewest matches of an alignment.");
  fields.add("static_match_prob", config.static_match_prob, "", {0.01, 0.99},
             "Probability that a detection of a static class has a landmark in the map.");
  fields.add("movable_match_prob", config.movable_match_prob, "", {0.01, 0.99},
             "The same for classes that may drive away.");
  fields.add("match_concentration", config.match_concentration, "", {0.01, 1e4},
             "How sure these two shares are: as if learned from so many detections.");
  fields.add("confusion_prob", config.confusion_prob, "", {0.0, 0.9},
             "Probability that the detector mistakes the class for another, static or movable as the true one.");
  fields.add("noise_floor", config.noise_floor_m, "m", {1e-3, 10.0},
             "Deviation of what covariances leave out: centroid bias, bending of the map.");
  fields.add("tilt_stddev", config.tilt_stddev_rad, "rad", {0.0, 0.5},
             "Error of roll and pitch, which moves distant detections up or down.");
  fields.add("density_radius", config.density_radius_m, "m", {1.0, 1000.0},
             "The density of landmarks, for chance matches, is counted so far around the detections.");
  fields.add("density_height", config.density_height_m, "m", {0.1, 100.0}, "Height that landmarks are spread over.");
  fields.add("distinct", config.distinct_m, "m", {0.0, 100.0}, "Alignments nearer than this are one,");
  fields.add("distinct_yaw", config.distinct_rad, "rad", {0.0, 3.2}, "if their headings are nearer than this.");
}

std::vector<AlignmentHypothesis> alignJointly(const std::vector<AlignmentPoint>& detections,
                                              const std::vector<AlignmentPoint>& landmarks, const AlignmentPrior& prior,
                                              const ClassTable& classes, const JointAlignmentConfig& config) {
  const AlignmentProblem problem = makeAlignmentProblem(detections, landmarks, prior, classes, config);
  std::vector<AlignmentHypothesis> result;
  for (const AlignmentMode& mode : findModes(problem, config)) {
    result.push_back(hypothesis(mode, problem, prior.T_a_b));
  }
  return result;
}

}  // namespace semantic_mht_slam
