#include "semantic_mht_slam/io/scan_file.h"

#include <cstring>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

template <class Number>
std::string bytesOf(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

class ScanFileTest : public ::testing::Test {
 protected:
  ScanFileTest() { writeFileAtomically(scan_, bytesOf<float>({1.0F, 2.0F, 3.0F, 0.5F, -4.0F, 5.0F, -6.0F, 0.1F})); }

  const TemporaryFolder folder_;
  const std::string scan_ = folder_ / "scan.bin";
  const std::string labels_ = folder_ / "scan.label";
};

TEST_F(ScanFileTest, PointsAndTheLowHalvesOfTheirLabelsAreRead) {
  writeFileAtomically(labels_, bytesOf<std::uint32_t>({0x00070050, 252}));
  const LabelledCloud cloud = readLabelledScan(scan_, labels_);
  EXPECT_EQ(cloud.points_m, (std::vector<Eigen::Vector3f>{{1.0F, 2.0F, 3.0F}, {-4.0F, 5.0F, -6.0F}}));
  EXPECT_EQ(cloud.labels, (std::vector<std::uint16_t>{80, 252}));
  EXPECT_EQ(readScan(scan_).points_m, cloud.points_m);
}

TEST_F(ScanFileTest, FilesThatDoNotFitEachOtherOrTheFormatAreRefused) {
  writeFileAtomically(labels_, bytesOf<std::uint32_t>({80}));
  expectInputError([&] { readLabelledScan(scan_, labels_); }, {"scan.label", "1 labels", "scan.bin", "2 points"});
  writeFileAtomically(labels_, "12345");
  expectInputError([&] { readLabelledScan(scan_, labels_); }, {"scan.label", "5 bytes"});
  expectInputError([&] { readScan(labels_); }, {"scan.label", "16 bytes"});
  expectInputError([&] { readScan(folder_ / "missing.bin"); }, {"missing.bin"});
}

TEST_F(ScanFileTest, EmptyScanWithEmptyLabelsHasNoPoints) {
  writeFileAtomically(scan_, "");
  writeFileAtomically(labels_, "");
  EXPECT_EQ(readLabelledScan(scan_, labels_).size(), 0U);
}

TEST(CameraFileTest, ObjectAndOdometryCalibrationsProjectToTheSamePixel) {
  const TemporaryFolder folder;
  const std::string p2 = "P2: 700 0 600 45 0 700 180 -0.3 0 0 1 0.005\n";
  const std::string transform = " 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3\n";
  writeFileAtomically(folder / "odometry.txt", p2 + "Tr:" + transform);
  writeFileAtomically(folder / "object.txt", p2 + "R0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam:" + transform);
  const Eigen::Vector3d point(10.0, 1.0, -0.5);
  const Eigen::Vector3d in_camera(-0.9, 0.3, 9.7);
  const Eigen::Vector2d expected((700 * in_camera.x() + 600 * in_camera.z() + 45) / (in_camera.z() + 0.005),
                                 (700 * in_camera.y() + 180 * in_camera.z() - 0.3) / (in_camera.z() + 0.005));
  for (const char* name : {"odometry.txt", "object.txt"}) {
    EXPECT_LT((*readCamera(folder / name).project(point) - expected).norm(), 1e-9) << name;
    EXPECT_FALSE(readCamera(folder / name).project({-5.0, 0.0, 0.0})) << "behind the camera";
  }
}

TEST(CameraFileTest, MissingAndBrokenLinesAreNamed) {
  const TemporaryFolder folder;
  const std::string path = folder / "calib.txt";
  const std::string p2 = "P2: 700 0 600 45 0 700 180 -0.3 0 0 1 0.005\n";
  writeFileAtomically(path, "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  expectInputError([&] { readCamera(path); }, {"calib.txt", "P2:"});
  writeFileAtomically(path, p2);
  expectInputError([&] { readCamera(path); }, {"calib.txt", "Tr_velo_to_cam:"});
  writeFileAtomically(path, p2 + "Tr: 0 -1 0 0 0 0 -1 0 1 0 0\n");
  expectInputError([&] { readCamera(path); }, {"calib.txt:2", "11 numbers"});
  writeFileAtomically(path, p2 + "Tr: 0 -1 0 0 0 0 -1 0 2 0 0 0\n");
  expectInputError([&] { readCamera(path); }, {"Tr:", "no rotation"});
  writeFileAtomically(path, p2 + "R0_rect: 1 0 0 0 x 0 0 0 1\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  expectInputError([&] { readCamera(path); }, {"calib.txt:2", "'x'"});
}

}  // namespace
}  // namespace semantic_mht_slam
