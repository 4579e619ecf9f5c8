#include "semantic_mht_slam/io/dataset.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

ClassTable makeTable() {
  std::vector<ClassInfo> classes(1);
  classes[0].name = "pole";
  return ClassTable(classes, "test");
}

Dataset makeDataset() {
  Dataset dataset;
  dataset.T_cam0_base = Pose{Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {0.1, -0.2, -0.3}};
  for (int i = 0; i < 3; ++i) {
    dataset.stamps.push_back(100000000LL * i);
    dataset.T_odom_base.push_back({expRotation({0.0, 0.0, 0.1 * i}), {1.0 * i, 0.0, 0.0}});
    Detection detection;
    detection.position_m = {10.0 - i, 1.5, 0.25};
    dataset.detections.push_back({detection});
  }
  dataset.T_map_base = dataset.T_odom_base;
  return dataset;
}

class DatasetTest : public ::testing::Test {
 protected:
  DatasetTest() { writeDataset(makeDataset(), classes_, folder_.path()); }

  Dataset read() const { return readDataset({folder_.path(), "objects.csv", "odometry/odometry.txt"}, classes_); }

  const ClassTable classes_ = makeTable();
  const TemporaryFolder folder_;
};

TEST_F(DatasetTest, WrittenFolderReadsBack) {
  const Dataset expected = makeDataset();
  const Dataset dataset = read();
  EXPECT_EQ(dataset.stamps, expected.stamps);
  ASSERT_TRUE(dataset.T_map_base);
  for (std::size_t i = 0; i < dataset.frames(); ++i) {
    EXPECT_LT((dataset.T_odom_base[i].matrix() - expected.T_odom_base[i].matrix()).norm(), 1e-12);
    EXPECT_LT(((*dataset.T_map_base)[i].matrix() - (*expected.T_map_base)[i].matrix()).norm(), 1e-12);
    EXPECT_EQ(dataset.detections[i][0].position_m, expected.detections[i][0].position_m);
  }
}

TEST_F(DatasetTest, CameraPosesBecomeBasePosesOfTheSameMotion) {
  const Pose T_cam0_base = makeDataset().T_cam0_base;
  const Pose T_world_cam0{expRotation({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  const Pose T_world_base = toBase(T_world_cam0, T_cam0_base);
  // A point fixed in the world, seen by the camera, is seen by the base at the place that the calibration says.
  const Eigen::Vector3d in_camera(0.5, -0.25, 7.0);
  const Eigen::Vector3d in_base = T_cam0_base.inverse() * in_camera;
  EXPECT_LT((T_cam0_base.inverse() * (T_world_cam0 * in_camera) - T_world_base * in_base).norm(), 1e-12);
  EXPECT_LT((toCamera(T_world_base, T_cam0_base).matrix() - T_world_cam0.matrix()).norm(), 1e-12);
}

TEST_F(DatasetTest, GroundTruthIsOptional) {
  std::filesystem::remove(folder_ / "poses.txt");
  EXPECT_FALSE(read().T_map_base);
}

TEST_F(DatasetTest, MissingFilesAndOtherRowCountsAreNamed) {
  writeFileAtomically(folder_ / "odometry/odometry.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expectInputError([&] { read(); }, {"odometry.txt", "1 poses", "times.txt has 3"});
  std::filesystem::remove(folder_ / "objects.csv");
  writeDataset(makeDataset(), classes_, folder_.path());
  writeFileAtomically(folder_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expectInputError([&] { read(); }, {"poses.txt", "1 poses"});
  writeFileAtomically(folder_ / "calib.txt", "P0: 1 2 3\n");
  expectInputError([&] { read(); }, {"calib.txt", "Tr:"});
  writeFileAtomically(folder_ / "calib.txt", "Tr: 5 0 0 0 0 1 0 0 0 0 1 0\n");
  expectInputError([&] { read(); }, {"calib.txt:1", "no rotation"});
  writeFileAtomically(folder_ / "calib.txt", "Tr: 1 2 3\n");
  expectInputError([&] { read(); }, {"calib.txt:1", "3 numbers"});
  std::filesystem::remove(folder_ / "times.txt");
  expectInputError([&] { read(); }, {"times.txt", "No such file"});
  expectInputError([&] { readDataset({folder_ / "none", "a", "b"}, classes_); }, {"none"});
}

}  // namespace
}  // namespace semantic_mht_slam
