#pragma once

#include "semantic_mht_slam/common/assignment.h"
#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/scene.h"

namespace semantic_mht_slam {

/// In which frame the positions of two scenes are compared.
enum class SceneFrame {
  kBase,       ///< as the sensor saw them, driving on in the same or in the opposite direction
  kPrincipal,  ///< relative to the centroid of the scene, x along its principal horizontal direction
};

/// What a pair of matched landmarks adds to the score.
enum class PairScoreFormula {
  kSimilarity,  ///< s_match (1 - s_class): near and of one class is best
  kAsPrinted,   ///< 1 - s_match s_class, as the paper prints it: a pair of one class adds 1 at whatever distance
};

/// Parameters of the landmark score of two scenes.
struct SceneScoreConfig {
  SceneFrame frame = SceneFrame::kBase;
  PairScoreFormula formula = PairScoreFormula::kSimilarity;
  double max_distance_m = 8.0;  ///< at which a pair is as bad as can be, H = 2
  double class_penalty = 0.8;   ///< p, in [0, 1]
  int min_objects = 5;          ///< with less in one of the scenes the score is 0
};

void describe(SceneScoreConfig& config, Fields& fields);

/// Similarity S_scene of the landmarks of two scenes in [0, 1] (paper, section III-B): matched by the Hungarian method
/// on their Euclidean distances, whatever their class, each pair adds to the score by its distance and classes.
///
/// Four choices where the paper is silent. H is the distance scaled to [0, 2], so that s_match = 1 - H/2 is in [0, 1].
/// The sum is divided by the number of pairs, as it would grow with the size of a scene otherwise. The printed formula,
/// in which the distance of a pair of one class has no influence, is the option kAsPrinted. And positions have to be in
/// one frame; that of a map which has drifted is none. On a street a vehicle stands nearly where it stood before and
/// faces one way or the other: kBase compares the scenes as they were seen. kPrincipal moves each scene to its centroid
/// and turns it into its principal horizontal direction, whatever the pose of the vehicle. Either way one scene is
/// compared as it is and turned by 180 degrees, and the more similar way counts.
/// Symmetric up to rounding; 0 for scenes with fewer than `min_objects` objects.
double sceneScore(const Scene& a, const Scene& b, const SceneScoreConfig& config);

/// At least `sceneScore`, without the assignment: as if each landmark of the smaller scene might have the other that
/// suits it best, whoever else has it. An order of magnitude faster.
double sceneScoreBound(const Scene& a, const Scene& b, const SceneScoreConfig& config);

}  // namespace semantic_mht_slam
