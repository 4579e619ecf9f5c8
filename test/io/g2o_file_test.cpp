#include "semantic_mht_slam/io/g2o_file.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

const char* const kPlanar =
    "# a comment\n"
    "2\n"
    "VERTEX_SE2 4 1 2 0.5\n"
    "VERTEX_SE2 3 0 0 0\r\n"
    "VERTEX_XY 9 5 6\n"
    "FIX 3\n"
    "EDGE_SE2 3 4 1 2 0.5  4 1 0 3 0 2\n"
    "EDGE_SE2_XY 4 9 3 3 2 0.5 2\n";

std::string complaint(const std::string& text, BadInformation policy = BadInformation::kRefuse) {
  try {
    parseG2o(text, "f.g2o", policy);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(G2oFileTest, PlanarFileIsReadInOrderOfIds) {
  const G2oFile file = parseG2o(kPlanar, "f.g2o");
  const auto& graph = std::get<BatchGraph<2>>(file.graph);
  ASSERT_EQ(graph.poses.size(), 2u);
  EXPECT_EQ(graph.poses[0].id, 3);
  EXPECT_EQ(graph.poses[1].T_world_vertex.translation_m, Eigen::Vector2d(1.0, 2.0));
  ASSERT_EQ(graph.pose_edges.size(), 1u);
  EXPECT_EQ(graph.pose_edges[0].from, 0);
  EXPECT_EQ(graph.pose_edges[0].information(1, 0), 1.0);
  EXPECT_EQ(graph.pose_edges[0].information(2, 2), 2.0);
  ASSERT_EQ(graph.point_edges.size(), 1u);
  EXPECT_EQ(graph.points[graph.point_edges[0].point].id, 9);
  EXPECT_EQ(graph.fixed_poses, std::vector<int>{0});
}

TEST(G2oFileTest, WrittenFileReadsBackAsTheSameText) {
  const std::string planar = formatG2o(parseG2o(kPlanar, "f.g2o"));
  EXPECT_EQ(formatG2o(parseG2o(planar, "f.g2o")), planar);
  const std::string spatial =
      "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 0 0.1 0 0 0 0 0 1\nVERTEX_TRACKXYZ 7 1 2 3\n"
      "EDGE_SE3:QUAT 0 1 1 0 0.3333333333333333 0.5 0.5 0.5 0.5 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n"
      "EDGE_SE3_TRACKXYZ 0 7 0 1 2 3 1 0 0 1 0 1\n";
  const std::string once = formatG2o(parseG2o(spatial, "f.g2o"));
  EXPECT_EQ(formatG2o(parseG2o(once, "f.g2o")), once);
  EXPECT_NE(once.find("0.3333333333333333"), std::string::npos);
}

TEST(G2oFileTest, VerticesThatOnlyEdgesNameHaveNoEstimate) {
  const G2oFile file = parseG2o("EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n", "f.g2o");
  const auto& graph = std::get<BatchGraph<2>>(file.graph);
  ASSERT_EQ(graph.poses.size(), 2u);
  EXPECT_FALSE(graph.poses[0].has_estimate);
}

TEST(G2oFileTest, EveryBadLineIsNamed) {
  const std::string good = "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
  const std::pair<std::string, std::string> cases[] = {
      {"EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n", "f.g2o:2: EDGE_SE2 0 1: too few fields"},
      {"EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1 7\n", "f.g2o:2: EDGE_SE2 0 1: too many fields"},
      {"EDGE_SE2 0 1 nan 0 0 1 0 0 1 0 1\n", "f.g2o:2: EDGE_SE2 0 1: 'nan' is not a finite number"},
      {"EDGE_SE2 0 1 1e999 0 0 1 0 0 1 0 1\n", "f.g2o:2: EDGE_SE2 0 1: '1e999' is not a"},
      {"EDGE_SE2 0 1 x 0 0 1 0 0 1 0 1\n", "f.g2o:2: EDGE_SE2 0 1: 'x' is not a number"},
      {"EDGE_SE2 0.5 1 1 0 0 1 0 0 1 0 1\n", "f.g2o:2: EDGE_SE2: '0.5' is not an integer"},
      {"EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n", "joins a vertex to itself"},
      {"EDGE_WHAT 0 1\n", "f.g2o:2: EDGE_WHAT: unknown tag"},
      {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n", "planar and spatial"},
      {"VERTEX_SE2 0 0 0 0\nVERTEX_SE2 0 0 0 0\n", "f.g2o:3: VERTEX_SE2 0: the vertex is defined twice"},
      {"FIX 12\n", "FIX 12: no such pose"},
  };
  for (const auto& [line, message] : cases) {
    EXPECT_NE(complaint(good + line).find(message), std::string::npos) << line << complaint(good + line);
  }
  EXPECT_NE(complaint("").find("no edge"), std::string::npos);
  EXPECT_NE(complaint("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 2\n").find("norm"), std::string::npos);
}

TEST(G2oFileTest, InformationThatIsNotPositiveDefiniteIsRefusedOrProjected) {
  const std::string indefinite = "EDGE_SE2 5 6 1 0 0  1 2 0 1 0 1\n";  // eigenvalues -1, 1, 3
  EXPECT_NE(complaint(indefinite).find("f.g2o:1: EDGE_SE2 5 6: the information matrix is not positive definite"),
            std::string::npos);
  const G2oFile file = parseG2o(indefinite, "f.g2o", BadInformation::kProject);
  ASSERT_EQ(file.projected_edges.size(), 1u);
  EXPECT_EQ(file.projected_edges[0], "f.g2o:1: EDGE_SE2 5 6");
  const auto& information = std::get<BatchGraph<2>>(file.graph).pose_edges[0].information;
  EXPECT_NEAR(information(0, 0), 1.5, 1e-6);  // 3/2 in the direction that was good, next to nothing in the other
  EXPECT_NEAR(information(0, 1), 1.5, 1e-6);
  EXPECT_NE(complaint("EDGE_SE2 5 6 1 0 0  1 0 0 1 0 0\n"), "") << "singular";
  EXPECT_NE(complaint("EDGE_SE2 5 6 1 0 0  -1 0 0 -1 0 -1\n", BadInformation::kProject), "") << "nothing to keep";
}

TEST(G2oFileTest, MissingFileAndFolderAreRefused) {
  EXPECT_THROW(readG2o("/nonexistent/a.g2o"), InputError);
  EXPECT_THROW(readG2o("/tmp"), InputError);
}

}  // namespace
}  // namespace semantic_mht_slam
