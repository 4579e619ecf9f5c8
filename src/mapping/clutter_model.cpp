#include "semantic_mht_slam/mapping/clutter_model.h"

#include <algorithm>
#include <cmath>

namespace semantic_mht_slam {
namespace {

constexpr double kLeastBirthProb = 1e-3;  // of a birth, and of none

}  // namespace

void describe(ClutterConfig& config, Fields& fields) {
  fields.add(
      "learn", config.learn,
      "Whether it is found out while driving how many detections of each class show nothing (the paper: false).");
  fields.add("prior_detections", config.prior_detections, "", {0.01, 1e6},
             "How many of them the rates that are given count for, against what is seen.");
}

ClutterModel::ClutterModel(const ClutterConfig& config, int class_count, double detections_per_frame, double volume_m3,
                           double max_range_m, double birth_prob)
    : config_(config),
      prior_density_per_m3_(detections_per_frame / (volume_m3 * class_count)),
      volume_m3_(volume_m3),
      max_range_m_(max_range_m),
      birth_prob_(birth_prob),
      of_class_(static_cast<std::size_t>(class_count)),
      of_cell_(static_cast<std::size_t>(class_count * PolarCells::kCount)) {}

std::size_t ClutterModel::cellOf(ClassIndex class_index, const Eigen::Vector3d& position_m) const {
  return static_cast<std::size_t>(class_index * PolarCells::kCount + PolarCells::cellOf(position_m, max_range_m_));
}

double ClutterModel::logDensity(ClassIndex class_index, const Eigen::Vector3d& position_m) const {
  const double prior = config_.prior_detections;
  const Counts& of_class = of_class_[static_cast<std::size_t>(class_index)];
  const double density_per_m3 = (of_class.clutter + prior) / (frames_ * volume_m3_ + prior / prior_density_per_m3_);
  const double share = PolarCells::areaShare(PolarCells::cellOf(position_m, max_range_m_));
  const double clutter = of_cell_[cellOf(class_index, position_m)].clutter;
  const double learned = (clutter + prior) / (frames_ * share * volume_m3_ + prior / density_per_m3);
  return std::log(std::max(learned, prior_density_per_m3_));
}

double ClutterModel::birthProb(ClassIndex class_index, const Eigen::Vector3d& position_m) const {
  const double prior = config_.prior_detections;
  const Counts& of_class = of_class_[static_cast<std::size_t>(class_index)];
  const double class_prob = (of_class.births + prior * birth_prob_) / (of_class.births + of_class.clutter + prior);
  const Counts& counts = of_cell_[cellOf(class_index, position_m)];
  const double prob = (counts.births + prior * class_prob) / (counts.births + counts.clutter + prior);
  return std::clamp(prob, kLeastBirthProb, birth_prob_);
}

void ClutterModel::addFrames(std::size_t frames) {
  if (config_.learn) frames_ += static_cast<double>(frames);
}

void ClutterModel::add(ClassIndex class_index, const Eigen::Vector3d& position_m, double clutter_prob,
                       double birth_prob) {
  if (!config_.learn) return;
  for (Counts* counts :
       {&of_cell_[cellOf(class_index, position_m)], &of_class_[static_cast<std::size_t>(class_index)]}) {
    counts->clutter += clutter_prob;
    counts->births += birth_prob;
  }
}

}  // namespace semantic_mht_slam
