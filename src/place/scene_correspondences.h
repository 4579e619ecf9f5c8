#pragma once

#include <vector>

#include "semantic_mht_slam/place/scene_alignment.h"

#include "scene_votes.h"

namespace semantic_mht_slam {

/// An object of the query and one of the match, by their places in PlanarScene::objects, that have similar
/// surroundings.
struct Correspondence {
  int query = 0;
  int match = 0;
};

/// For each object of the query the `per_object` objects of its class whose neighbours, by class and distance, are most
/// alike. Most are wrong.
std::vector<Correspondence> findCorrespondences(const PlanarScene& query, const PlanarScene& match, int per_object);

/// The motion in the plane that brings corresponding objects onto each other with least squares.
PlanarGuess motionOf(const PlanarScene& query, const PlanarScene& match,
                     const std::vector<Correspondence>& correspondences);

/// Distance between an object of the query after the motion and its counterpart.
double residual(const PlanarScene& query, const PlanarScene& match, const PlanarGuess& motion,
                const Correspondence& correspondence);

/// Guesses by maximum cliques of correspondences that keep their distances (Bailey, Mobile Robot Localisation and
/// Mapping in Extensive Outdoor Environments, 2002); each further guess is from what earlier ones leave.
std::vector<PlanarGuess> guessByCliques(const PlanarScene& query, const PlanarScene& match);

/// The same by random sample consensus.
std::vector<PlanarGuess> guessByRansac(const PlanarScene& query, const PlanarScene& match);

}  // namespace semantic_mht_slam
