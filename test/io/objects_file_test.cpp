#include "semantic_mht_slam/io/objects_file.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/models/usable_detection.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

ClassTable makeObjectClasses() {
  std::vector<ClassInfo> classes(2);
  classes[0].name = "pole";
  classes[1].name = "trunk";
  classes[1].id = 1;
  return ClassTable(classes, "test");
}

class ObjectsFileTest : public ::testing::Test {
 protected:
  std::vector<Detections> read(const std::string& content, std::size_t frames = 3) {
    writeFileAtomically(path_, content);
    ObjectsFile file = readObjects(path_, classes_, frames);
    notice_ = file.notice;
    return file.detections;
  }

  void expectRefused(const std::string& content, const std::vector<std::string>& parts) {
    expectInputError([&] { read(content); }, parts);
  }

  const ClassTable classes_ = makeObjectClasses();
  std::string notice_;
  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "objects.csv";
};

TEST_F(ObjectsFileTest, RowsReachTheirFramesInFileOrder) {
  const auto frames = read("frame,class,x,y,z\n2,trunk,1,2,3\n0,pole,4,5,6\n2,pole,7,8,-9.5\n");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].size(), 1U);
  EXPECT_TRUE(frames[1].empty());
  ASSERT_EQ(frames[2].size(), 2U);
  EXPECT_EQ(frames[2][1].position_m, Eigen::Vector3d(7.0, 8.0, -9.5));
  EXPECT_EQ(frames[2][0].class_index, 1);
  EXPECT_EQ(frames[2][1].row, 1);
  EXPECT_FALSE(frames[2][1].score || frames[2][1].cov_m2 || frames[2][1].size_m);
}

TEST_F(ObjectsFileTest, OptionalColumnsMayComeInAnyOrderAndBeEmpty) {
  const auto frames = read(
      "score,frame,class,x,y,z,sxx,sxy,sxz,syy,syz,szz,size_x,size_y,size_z\n"
      "0.5,0,pole,1,2,3,1,0.1,0.2,2,0.3,3,0.4,0.5,6\n"
      ",0,pole,1,2,3,,,,,,,,,\n");
  const Detection& full = frames[0][0];
  EXPECT_EQ(full.score, 0.5);
  EXPECT_EQ((*full.cov_m2)(2, 1), 0.3);
  EXPECT_EQ((*full.cov_m2)(1, 2), 0.3);
  EXPECT_EQ(*full.size_m, Eigen::Vector3d(0.4, 0.5, 6.0));
  const Detection& bare = frames[0][1];
  EXPECT_FALSE(bare.score || bare.cov_m2 || bare.size_m);
}

TEST_F(ObjectsFileTest, WrittenObjectsReadBack) {
  const std::string text =
      "frame,class,x,y,z,score,sxx,sxy,sxz,syy,syz,szz\n0,pole,1.250,2.000,-3.000,0.5,1,0.1,0.2,2,0.3,3\n"
      "2,trunk,0.000,0.000,0.001,,,,,,,\n";
  EXPECT_EQ(formatObjects(read(text), classes_), text);
}

TEST_F(ObjectsFileTest, BadRowsAreNamedByFileLineAndColumn) {
  const std::string head = "frame,class,x,y,z\n";
  expectRefused(head + "0,pole,1,two,3\n", {"objects.csv:2", "column 'y'", "not a number"});
  expectRefused(head + "0,pole,1,2\n", {"objects.csv:2", "4 columns, the header has 5"});
  expectRefused(head + "0,pole,1,2,3,4\n", {"objects.csv:2", "6 columns"});
  expectRefused(head + "0,tree,1,2,3\n", {"objects.csv:2", "unknown class 'tree'", "pole, trunk"});
  expectRefused(head + "3,pole,1,2,3\n", {"objects.csv:2", "frame 3", "3 frames"});
  expectRefused(head + "-1,pole,1,2,3\n", {"objects.csv:2", "frame -1"});
  expectRefused(head + "0.5,pole,1,2,3\n", {"objects.csv:2", "'0.5' is not a whole number"});
  expectRefused(head + "0,pole,,2,3\n", {"objects.csv:2", "column 'x'", "empty"});
  expectRefused("frame,class,x,y\n", {"objects.csv:1", "'z' is missing"});
  expectRefused("frame,class,x,y,heigth\n", {"objects.csv:1", "'z' is missing", "not known: heigth"});
  expectRefused("frame,class,x,y,z,x\n", {"objects.csv:1", "'x' stands twice"});
  expectRefused("frame,class,x,y,z,sxx\n0,pole,1,2,3,1\n", {"objects.csv:2", "'sxy'"});
  expectRefused("", {"objects.csv", "empty"});
}

TEST_F(ObjectsFileTest, ColumnsThatAreNotKnownAreIgnoredWithAWord) {
  const auto frames = read("frame,velocity,class,x,y,z,track\n0,7.5,pole,1,2,3,a b\n");
  ASSERT_EQ(frames[0].size(), 1U);
  EXPECT_EQ(frames[0][0].position_m, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NE(notice_.find("objects.csv: ignored columns"), std::string::npos) << notice_;
  EXPECT_NE(notice_.find("velocity, track"), std::string::npos) << notice_;
  read("frame,class,x,y,z\n0,pole,1,2,3\n");
  EXPECT_EQ(notice_, "");
}

TEST_F(ObjectsFileTest, NumbersThatAreNotFiniteAreReadAndNotUsable) {
  const auto frames = read(
      "frame,class,x,y,z,score,sxx,sxy,sxz,syy,syz,szz\n"
      "0,pole,1,nan,3,0.5,1,0,0,1,0,1\n0,pole,1,2,-inf,0.5,1,0,0,1,0,1\n0,pole,1,2,3,nan,1,0,0,1,0,1\n"
      "0,pole,1,2,3,0.5,1,0,0,nan,0,1\n0,pole,1,2,3,0.5,1,0,0,1,0,1\n");
  ASSERT_EQ(frames[0].size(), 5U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(isUsable(frames[0][i])) << i;
  EXPECT_TRUE(isUsable(frames[0][4]));
  EXPECT_EQ(frames[0][4].row, 4);
}

TEST_F(ObjectsFileTest, PointCountsAndMovingFlagsComeBackAndBadOnesAreNamed) {
  Detection pole;
  pole.points = 25;
  Detection car;
  car.class_index = 1;
  car.is_moving = true;
  const std::string text = formatObjects({{pole}, {car}}, classes_);
  EXPECT_EQ(text, "frame,class,x,y,z,points,moving\n0,pole,0.000,0.000,0.000,25,0\n1,trunk,0.000,0.000,0.000,,1\n");
  const auto frames = read(text);
  EXPECT_EQ(frames[0][0].points, 25);
  EXPECT_FALSE(frames[0][0].is_moving);
  EXPECT_EQ(frames[1][0].points, std::nullopt);
  EXPECT_TRUE(frames[1][0].is_moving);
  expectRefused("frame,class,x,y,z,points\n0,pole,1,2,3,-1\n", {"objects.csv:2", "'points'"});
  expectRefused("frame,class,x,y,z,moving\n0,pole,1,2,3,2\n", {"objects.csv:2", "'moving'"});
}

}  // namespace
}  // namespace semantic_mht_slam
