#pragma once

#include <string>
#include <variant>
#include <vector>

#include "semantic_mht_slam/graph/batch_graph.h"

namespace semantic_mht_slam {

/// Content of a g2o pose-graph file.
struct G2oFile {
  std::variant<BatchGraph<2>, BatchGraph<3>> graph;
  std::vector<std::string>
      projected_edges;  ///< "file:line: EDGE_SE2 3 7" of every information matrix that was repaired
};

/// What to do with information matrices that are not positive definite.
enum class BadInformation {
  kRefuse,   ///< throw an InputError that names the edge
  kProject,  ///< raise eigenvalues below 1e-9 of the largest to that value
};

/// Reads VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY or VERTEX_SE3:QUAT, VERTEX_TRACKXYZ, EDGE_SE3:QUAT,
/// EDGE_SE3_TRACKXYZ (its sensor offset, PARAMS_SE3OFFSET, must be the identity) and FIX. Vertices that only edges name
/// have no estimate. Lines that hold a number alone (the vertex count of some public files) and comments are skipped.
///
/// Anything else throws InputError with the file and line: unknown tags, wrong counts, text or NaN in place of a
/// number, a vertex defined twice, an edge from a vertex to itself, planar and spatial elements mixed, no edge at all.
G2oFile readG2o(const std::string& path, BadInformation bad_information = BadInformation::kRefuse);

/// Parses the text of a g2o file; `name` stands for the file in messages.
G2oFile parseG2o(const std::string& text, const std::string& name,
                 BadInformation bad_information = BadInformation::kRefuse);

/// The graph as g2o text; numbers read back exactly.
std::string formatG2o(const G2oFile& file);

}  // namespace semantic_mht_slam
