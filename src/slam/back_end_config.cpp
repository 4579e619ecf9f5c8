#include "semantic_mht_slam/slam/back_end_config.h"

namespace semantic_mht_slam {

void describe(BackEndConfig& config, Fields& fields) {
  fields.add("close_loops", config.close_loops, "Whether places that are seen again correct the trajectory.");
  fields.add("recognise_places", config.recognise_places,
             "Whether places are recognised by their objects alone, wherever the pose is believed to be.");
  fields.add("landmark_factors", config.landmark_factors, "Whether landmarks take part in the pose graph.");
  fields.add("closure_stride", config.closure_stride, "", {1, 1000}, "Every n-th keyframe is looked for in the map.");
  fields.add("loop_cov_scale", config.loop_cov_scale, "", {0.01, 1e4}, "Factor on the covariance of a loop closure.");
  fields.add("loop_floor", config.loop_floor_m, "m", {0.001, 10.0}, "Least position deviation of a loop closure.");
  fields.add("loop_floor_rad", config.loop_floor_rad, "rad", {1e-5, 1.0}, "Least rotation deviation of one.");
  fields.group("keyframe", config.keyframe);
  fields.group("evaluator", config.evaluator);
  fields.group("place", config.place);
  fields.group("revisit", config.revisit);
  fields.group("graph", config.graph);
}

}  // namespace semantic_mht_slam
