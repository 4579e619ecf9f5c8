#include "semantic_mht_slam/io/g2o_file.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

#include "g2o_elements.h"
#include "g2o_line.h"

namespace semantic_mht_slam {
namespace {

/// Builds one graph from the lines of a file.
template <int kDim>
class Parser {
 public:
  using Graph = BatchGraph<kDim>;

  Parser(G2oFile& file, BadInformation policy)
      : file_(file), policy_(policy), graph_(file.graph.template emplace<Graph>()) {}

  /// False if the tag is none of this dimension.
  bool parse(G2oLine& line) {
    if (line.tag() == Tags<kDim>::kPose) {
      readPose(line, poses_.define(line.integer(), line).T_world_vertex);
      line.finish();
    } else if (line.tag() == Tags<kDim>::kPoint) {
      typename Graph::Point& point = points_.define(line.integer(), line).position_m;
      for (int i = 0; i < kDim; ++i) point[i] = line.number();
      line.finish();
    } else if (line.tag() == Tags<kDim>::kPoseEdge) {
      parsePoseEdge(line);
    } else if (line.tag() == Tags<kDim>::kPointEdge) {
      parsePointEdge(line);
    } else if (line.tag() == "FIX") {
      while (!line.atEnd()) fixed_ids_.push_back({line.integer(), line.name()});
    } else if (line.tag() == "PARAMS_SE3OFFSET" && kDim == 3) {
      parseOffset(line);
    } else {
      return false;
    }
    return true;
  }

  void finish(const std::string& name) {
    if (graph_.pose_edges.empty() && graph_.point_edges.empty()) throw InputError(name + ": no edge in the file");
    for (const auto& point : graph_.points) {
      if (poses_.contains(point.id)) {
        throw InputError(name + ": vertex " + std::to_string(point.id) + " is a pose and a point");
      }
    }
    const std::vector<int> pose_index = poses_.sortById();
    const std::vector<int> point_index = points_.sortById();
    for (auto& edge : graph_.pose_edges) {
      edge.from = pose_index[edge.from];
      edge.to = pose_index[edge.to];
    }
    for (auto& edge : graph_.point_edges) {
      edge.pose = pose_index[edge.pose];
      edge.point = point_index[edge.point];
    }
    resolveFixed();
  }

 private:
  void parsePoseEdge(G2oLine& line) {
    typename Graph::PoseEdge& edge = graph_.pose_edges.emplace_back();
    edge.from = poses_.indexOf(line.integer());
    edge.to = poses_.indexOf(line.integer());
    if (edge.from == edge.to) line.fail("the edge joins a vertex to itself");
    readPose(line, edge.T_from_to);
    edge.information = readInformation<Graph::kDof>(line, policy_, file_);
  }

  void parsePointEdge(G2oLine& line) {
    typename Graph::PointEdge& edge = graph_.point_edges.emplace_back();
    edge.pose = poses_.indexOf(line.integer());
    edge.point = points_.indexOf(line.integer());
    if (kDim == 3 && identity_offsets_.count(line.integer()) == 0) line.fail("PARAMS_SE3OFFSET is not defined");
    for (int i = 0; i < kDim; ++i) edge.position_m[i] = line.number();
    edge.information = readInformation<kDim>(line, policy_, file_);
  }

  void parseOffset(G2oLine& line) {
    const std::int64_t id = line.integer();
    Pose offset;
    readPose(line, offset);
    line.finish();
    if (!offset.translation_m.isZero(1e-12) || !offset.rotation.vec().isZero(1e-12)) {
      line.fail("only the identity is supported as sensor offset");
    }
    identity_offsets_.insert(id);
  }

  void resolveFixed() {
    for (const auto& [id, where] : fixed_ids_) {
      const auto vertex = std::lower_bound(graph_.poses.begin(), graph_.poses.end(), id,
                                           [](const auto& pose, std::int64_t value) { return pose.id < value; });
      if (vertex == graph_.poses.end() || vertex->id != id) throw InputError(where + ": no such pose");
      graph_.fixed_poses.push_back(static_cast<int>(vertex - graph_.poses.begin()));
    }
  }

  G2oFile& file_;
  BadInformation policy_;
  Graph& graph_;
  VertexTable<typename Graph::PoseVertex> poses_{graph_.poses};
  VertexTable<typename Graph::PointVertex> points_{graph_.points};
  std::set<std::int64_t> identity_offsets_;
  std::vector<std::pair<std::int64_t, std::string>> fixed_ids_;
};

enum class Dimension { kUnknown, kPlanar, kSpatial };

Dimension dimensionOf(const std::string& tag) {
  for (const char* planar : {Tags<2>::kPose, Tags<2>::kPoint, Tags<2>::kPoseEdge, Tags<2>::kPointEdge}) {
    if (tag == planar) return Dimension::kPlanar;
  }
  for (const char* spatial :
       {Tags<3>::kPose, Tags<3>::kPoint, Tags<3>::kPoseEdge, Tags<3>::kPointEdge, "PARAMS_SE3OFFSET"}) {
    if (tag == spatial) return Dimension::kSpatial;
  }
  return Dimension::kUnknown;
}

/// A lone number is the vertex count that some public files carry.
bool isHarmless(G2oLine& line) {
  return line.tag().empty() || line.tag().front() == '#' || (parseInteger(line.tag()) && line.atEnd());
}

/// Calls `use` with every line that holds an element.
template <class Use>
void forEachElement(const std::string& text, const std::string& name, const Use& use) {
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    G2oLine line(std::string_view(text).substr(begin, end - begin), name, ++number);
    if (!isHarmless(line)) use(line);
    begin = end + 1;
  }
}

Dimension findDimension(const std::string& text, const std::string& name) {
  Dimension dimension = Dimension::kUnknown;
  forEachElement(text, name, [&](const G2oLine& line) {
    if (dimension == Dimension::kUnknown) dimension = dimensionOf(line.tag());
  });
  return dimension;
}

template <int kDim>
void parseGraph(const std::string& text, const std::string& name, BadInformation policy, G2oFile& file) {
  Parser<kDim> parser(file, policy);
  forEachElement(text, name, [&](G2oLine& line) {
    if (parser.parse(line)) return;
    const bool mixed = dimensionOf(line.tag()) != Dimension::kUnknown;
    line.fail(mixed ? "planar and spatial elements in one file" : "unknown tag");
  });
  parser.finish(name);
}

void append(std::string& text, const Pose2& pose) {
  for (const double value : {pose.translation_m.x(), pose.translation_m.y(), pose.heading_rad}) {
    appendNumber(text, value);
  }
}

void append(std::string& text, const Pose& pose) {
  for (int i = 0; i < 3; ++i) appendNumber(text, pose.translation_m[i]);
  for (int i = 0; i < 4; ++i) appendNumber(text, pose.rotation.coeffs()[i]);
}

template <int kSize>
void append(std::string& text, const Eigen::Matrix<double, kSize, 1>& vector) {
  for (int i = 0; i < kSize; ++i) appendNumber(text, vector[i]);
}

template <class Matrix>
void appendUpperTriangle(std::string& text, const Matrix& matrix) {
  for (int row = 0; row < matrix.rows(); ++row) {
    for (int col = row; col < matrix.cols(); ++col) appendNumber(text, matrix(row, col));
  }
  text += '\n';
}

template <int kDim>
void appendVertices(std::string& text, const BatchGraph<kDim>& graph) {
  for (const auto& vertex : graph.poses) {
    text += Tags<kDim>::kPose + (" " + std::to_string(vertex.id));
    append(text, vertex.T_world_vertex);
    text += '\n';
  }
  for (const auto& vertex : graph.points) {
    text += Tags<kDim>::kPoint + (" " + std::to_string(vertex.id));
    append(text, vertex.position_m);
    text += '\n';
  }
  for (const int index : graph.fixed_poses) text += "FIX " + std::to_string(graph.poses[index].id) + "\n";
}

template <int kDim>
std::string formatGraph(const BatchGraph<kDim>& graph) {
  std::string text;
  if (kDim == 3 && !graph.point_edges.empty()) text += "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n";
  appendVertices(text, graph);
  for (const auto& edge : graph.pose_edges) {
    text += Tags<kDim>::kPoseEdge;
    text += " " + std::to_string(graph.poses[edge.from].id) + " " + std::to_string(graph.poses[edge.to].id);
    append(text, edge.T_from_to);
    appendUpperTriangle(text, edge.information);
  }
  for (const auto& edge : graph.point_edges) {
    text += Tags<kDim>::kPointEdge;
    text += " " + std::to_string(graph.poses[edge.pose].id) + " " + std::to_string(graph.points[edge.point].id);
    if (kDim == 3) text += " 0";
    append(text, edge.position_m);
    appendUpperTriangle(text, edge.information);
  }
  return text;
}

}  // namespace

G2oFile parseG2o(const std::string& text, const std::string& name, BadInformation bad_information) {
  G2oFile file;
  if (findDimension(text, name) == Dimension::kSpatial) {
    parseGraph<3>(text, name, bad_information, file);
  } else {
    parseGraph<2>(text, name, bad_information, file);
  }
  return file;
}

G2oFile readG2o(const std::string& path, BadInformation bad_information) {
  return parseG2o(readFile(path), path, bad_information);
}

std::string formatG2o(const G2oFile& file) {
  return std::visit([](const auto& graph) { return formatGraph(graph); }, file.graph);
}

}  // namespace semantic_mht_slam
