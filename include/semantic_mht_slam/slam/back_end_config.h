#pragma once

#include "semantic_mht_slam/graph/pose_graph.h"
#include "semantic_mht_slam/place/place_config.h"
#include "semantic_mht_slam/place/submap_evaluator.h"
#include "semantic_mht_slam/slam/keyframes.h"
#include "semantic_mht_slam/slam/revisit_search.h"

namespace semantic_mht_slam {

/// Everything behind the mapper.
struct BackEndConfig {
  bool close_loops = true;
  bool recognise_places = true;
  bool landmark_factors = true;
  int closure_stride = 2;
  double loop_cov_scale = 1.0;
  Length loop_floor_m{0.1};
  double loop_floor_rad = 0.005;
  KeyframeConfig keyframe;
  SubmapEvaluatorConfig evaluator;  ///< `tree` is opened as it stands
  PlaceConfig place;
  RevisitConfig revisit;
  PoseGraphConfig graph;
};

void describe(BackEndConfig& config, Fields& fields);

}  // namespace semantic_mht_slam
