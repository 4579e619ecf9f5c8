#include "semantic_mht_slam/mapping/mapper_config.h"

namespace semantic_mht_slam {

void describe(AssociationConfig& config, Fields& fields) {
  fields.add("gate_prob", config.gate_prob, "", {0.5, 0.999999},
             "Share of true associations that the chi-square gate lets through.");
  fields.add("max_gate", config.max_gate_m, "m", {0.1, 100.0}, "Detections further from a landmark are never its own.");
  fields.add<CountPrior>(
      "count_prior", config.count_prior,
      {{"none", CountPrior::kNone}, {"linear", CountPrior::kLinear}, {"exponential", CountPrior::kExponential}},
      "Weight g(N) of a landmark with N detections: 1, N (Chinese restaurant process) or exp(N) (the paper).");
  fields.add("count_prior_cap", config.count_prior_cap, "", {1, 700}, "N is not counted beyond this.");
  fields.add("concentration", config.concentration, "", {1e-9, 1e9},
             "alpha of the Dirichlet process: readiness to make a new landmark.");
  fields.add("false_positive_rate", config.false_positive_rate, "", {1e-9, 1e9},
             "rho: readiness to call a detection a false positive.");
  fields.add("map_volume", config.map_volume_m3, "m^3", {1.0, 1e9},
             "|M|, the volume that the sensor sweeps in a submap.");
  fields.add<ClassModel>("class_model", config.class_model,
                         {{"delta", ClassModel::kDelta}, {"confusion", ClassModel::kConfusion}},
                         "Whether a detection's class is always right (the paper) or may be confused.");
  fields.add("confusion_prob", config.confusion_prob, "", {0.0, 0.9},
             "Probability that a detection's class is wrong, before it is known.");
  fields.add("confusion_samples", config.confusion_samples, "", {1.0, 1e12},
             "Detections that this counts for in each class, against what is seen.");
  fields.add("learn_confusion", config.learn_confusion,
             "Whether it is found out while driving which classes the detector takes for which (the paper: false).");
  fields.add("new_density", config.new_density, "1/frame", {1e-6, 1e3},
             "lambda_n V: mean number of new landmarks in a frame.");
  fields.add("false_positive_density", config.false_positive_density, "1/frame", {1e-6, 1e3},
             "lambda_f V: mean number of false positives in a frame.");
  fields.add(
      "outlier_prob", config.outlier_prob, "", {0.0, 0.9},
      "Share of detections whose centroid is far off though the object is right (badly clustered, another side of "
      "a building); 0: Gaussian noise (the paper).");
  fields.add("outlier_factor", config.outlier_factor, "", {1.0, 100.0},
             "Their deviation along the ray, across it and vertically, in deviations of the noise,");
  fields.add("outlier_min_stddev", config.outlier_min_stddev_m, "m", {0.0, 100.0},
             "and what is added to it in all directions.");
  fields.add("ukf_gate", config.ukf_gate_m, "m", {0.1, 100.0},
             "Gate of the ukf baseline's nearest-neighbour assignment.");
  fields.add(
      "split_prob", config.split_prob, "", {0.0, 0.9},
      "Share of objects that are detected in two parts. A detection that would be new is a second part of a landmark "
      "that another one took if that is likelier than clutter or a neighbour; 0: never (the paper).");
}

void describe(TreeConfig& config, Fields& fields) {
  fields.add("max_hypotheses", config.max_hypotheses, "", {1, 10000}, "Hard cap of the hypotheses that live.");
  fields.add("max_branches", config.max_branches, "", {1, 1000}, "Children that one hypothesis may have in one frame.");
  fields.add("branch_log_ratio", config.branch_log_ratio, "nats", {0.0, 100.0},
             "Alternatives less likely than the best assignment by more than this are not followed.");
  fields.add("ess_ratio", config.ess_ratio, "", {0.0, 1.0},
             "Resampling happens when the effective sample size falls below this share of the hypotheses.");
  fields.add("kld_epsilon", config.kld_epsilon, "", {1e-4, 1.0}, "Error bound of KLD sampling (Fox 2003).");
  fields.add("kld_delta", config.kld_delta, "", {1e-6, 0.5}, "Probability that the error bound is exceeded.");
  fields.add("min_weight", config.min_weight, "", {0.0, 0.5}, "Hypotheses below this weight are dropped.");
}

void describe(SubmapConfig& config, Fields& fields) {
  fields.add("length", config.length_m, "m", {1.0, 1000.0}, "Travelled length of a submap,");
  fields.add("turn", config.turn_rad, "rad", {0.1, 1000.0}, "unless it turned so much in it,");
  fields.add("max_frames", config.max_frames, "frames", {10, 1000000}, "or has so many frames.");
  fields.add("correct_pose", config.correct_pose,
             "Whether each hypothesis corrects the odometry within the submap by its landmarks (the paper: false).");
  fields.add("propagation", config.propagation_m, "m", {0.0, 10000.0},
             "Landmarks seen within this travelled distance go on into the next submap.");
}

MapperConfig defaultsOf(Estimator estimator) {
  MapperConfig config;
  config.estimator = estimator;
  if (estimator == Estimator::kDpmhm) return config;
  config.association.count_prior = CountPrior::kNone;
  config.association.outlier_prob = 0.0;
  config.association.learn_confusion = false;
  config.clutter.learn = false;
  config.moving.find = false;
  config.association.split_prob = 0.0;
  config.submap.correct_pose = false;
  config.duplicates.merge = false;
  config.bias.enabled = false;
  config.alignment.enabled = false;
  return config;
}

void describe(MapperConfig& config, Fields& fields) {
  fields.add(
      "semantics", config.semantics,
      "false: classes say nothing of which detection is which landmark (ablation); noise and probability of detection "
      "stay those of the class.");
  fields.add<MeasurementModel>(
      "measurement_model", config.measurement_model,
      {{"additive", MeasurementModel::kAdditive}, {"range_bearing", MeasurementModel::kRangeBearing}},
      "How the detector measures: a position (the paper), or range, bearing and elevation, which suits far detections "
      "whose range is well and whose direction is badly known.");
  describe(config.tree, fields);
  describe(config.association, fields);
  fields.group("detection", config.detection);
  fields.group("clutter", config.clutter);
  fields.group("moving", config.moving);
  fields.group("submap", config.submap);
  fields.group("odometry", config.odometry);
  fields.group("calibration", config.calibration);
  fields.group("bias", config.bias);
  fields.group("alignment", config.alignment);
  fields.group("duplicates", config.duplicates);
}

}  // namespace semantic_mht_slam
