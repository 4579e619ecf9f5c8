#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/run_program.h"
#include "support/scans.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

/// A scan of one pole of SemanticKITTI's raw label on disk.
class ExtractObjectsTest : public ::testing::Test {
 protected:
  ExtractObjectsTest() {
    Rng rng(1);
    LabelledCloud cloud;
    addBox(cloud, {10.0, 2.0, 0.0}, {0.2, 0.2, 3.0}, 40, 80, rng);
    write(cloud, folder_ / "scan");
  }

  static void write(const LabelledCloud& cloud, const std::string& path) {
    std::string points;
    std::string labels;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float values[4] = {cloud.points_m[i].x(), cloud.points_m[i].y(), cloud.points_m[i].z(), 0.5F};
      const std::uint32_t label = cloud.labels[i];
      points.append(reinterpret_cast<const char*>(values), sizeof(values));
      labels.append(reinterpret_cast<const char*>(&label), sizeof(label));
    }
    writeFileAtomically(path + ".bin", points);
    writeFileAtomically(path + ".label", labels);
  }

  ProgramResult extract(const std::string& arguments) const {
    return runProgramOfPackage("extract_objects", arguments + " --output '" + output_ + "'");
  }

  void expectRefused(const std::string& arguments, const std::string& part) const {
    const ProgramResult result = extract(arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments << "\n" << result.output;
    EXPECT_EQ(result.output.rfind("extract_objects: ", 0), 0U) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output << "lacks: " << part;
    EXPECT_FALSE(fs::exists(output_)) << "something was written";
  }

  std::string config(const std::string& name) const { return std::string(SMHT_SOURCE_DIR) + "/config/" + name; }

  const TemporaryFolder folder_;
  const std::string scan_ = "--scan '" + folder_ / "scan.bin" + "' ";
  const std::string labels_ = "--labels '" + folder_ / "scan.label" + "' ";
  const std::string output_ = folder_ / "objects.csv";
};

TEST_F(ExtractObjectsTest, LabelMapAndClassTableGiveTheSameObjects) {
  std::vector<std::string> outputs;
  for (const std::string file : {"labels_semantic_kitti.yaml", "classes_semantic_kitti.yaml"}) {
    const ProgramResult result = extract(scan_ + labels_ + "--classes '" + config(file) + "'");
    ASSERT_EQ(result.exit_code, 0) << result.output;
    outputs.push_back(readFile(output_));
  }
  EXPECT_EQ(outputs[0], outputs[1]);
  EXPECT_EQ(outputs[0].rfind("frame,class,x,y,z,score,sxx,sxy,sxz,syy,syz,szz,size_x,size_y,size_z,points\n0,pole,", 0),
            0U)
      << outputs[0];
  EXPECT_EQ(std::count(outputs[0].begin(), outputs[0].end(), '\n'), 2);
}

TEST_F(ExtractObjectsTest, ShippedParametersAreTheDefaults) {
  ASSERT_EQ(extract(scan_ + labels_).exit_code, 0);
  const std::string by_default = readFile(output_);
  const ProgramResult result = extract(scan_ + labels_ + "--config '" + config("extraction.yaml") + "'");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(readFile(output_), by_default);
}

TEST_F(ExtractObjectsTest, ParametersOfOneClassCanBeSet) {
  ASSERT_EQ(extract(scan_ + labels_ + "--set classes.pole.min_points=41").exit_code, 0);
  EXPECT_EQ(readFile(output_), "frame,class,x,y,z\n");
}

TEST_F(ExtractObjectsTest, UnknownLabelsAreToldAndTheRestIsUsed) {
  Rng rng(2);
  LabelledCloud cloud;
  addBox(cloud, {10.0, 2.0, 0.0}, {0.2, 0.2, 3.0}, 40, 80, rng);
  addBox(cloud, {10.0, 8.0, 0.0}, {0.2, 0.2, 3.0}, 30, 777, rng);
  write(cloud, folder_ / "scan");
  const ProgramResult result = extract(scan_ + labels_);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("scan.label: skipped label ids that are not in the class map: 777 (30 points)"),
            std::string::npos)
      << result.output;
}

TEST_F(ExtractObjectsTest, BadOptionsAndFilesAreRefusedWithoutOutput) {
  expectRefused(labels_, "--scan");
  expectRefused(scan_, "--image-labels");
  expectRefused(scan_ + labels_ + "--image-labels x.png", "either");
  expectRefused(scan_ + "--image-labels x.png", "--calib");
  expectRefused(scan_ + "--labels /no/such.label", "/no/such.label");
  expectRefused(scan_ + labels_ + "--classes /no/such.yaml", "/no/such.yaml");
  expectRefused(scan_ + labels_ + "--set classes.pol.min_points=3", "classes.pol.min_points");
  expectRefused(scan_ + labels_ + "--set max_range=-1", "out of range");
  expectRefused(scan_ + labels_ + "--set classes.pole.voxel=0.4", "classes.pole.voxel");
  expectRefused(scan_ + labels_ + "--set min_range=200", "min_range");
  writeFileAtomically(folder_ / "calib.txt", "P2: 700 0 600 0 0 700 180 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  const std::string calib = "--calib '" + folder_ / "calib.txt" + "' ";
  expectRefused(scan_ + calib + "--image-labels '" + folder_ / "scan.bin" + "'", "not an image");
  writeFileAtomically(folder_ / "scan.label", "1234");
  expectRefused(scan_ + labels_, "1 labels");
}

TEST_F(ExtractObjectsTest, KittiToBagTakesTheObjectsOfLabelledScans) {
  const std::string drive = folder_ / "drive";
  fs::create_directories(drive + "/velodyne");
  fs::create_directories(drive + "/labels");
  writeFileAtomically(drive + "/times.txt", "0.0\n0.1\n0.2\n");
  writeFileAtomically(drive + "/calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  writeFileAtomically(drive + "/odometry.txt",
                      "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 2\n");
  const std::string arguments = "--dataset '" + drive + "' --odometry odometry.txt --output '" + drive + "/drive.bag'";
  ProgramResult result = runProgramOfPackage("kitti_to_bag", arguments);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("no frame has both"), std::string::npos) << result.output;
  for (const char* name : {"000000", "000002"}) {
    fs::copy_file(folder_ / "scan.bin", drive + "/velodyne/" + name + ".bin");
    fs::copy_file(folder_ / "scan.label", drive + "/labels/" + name + ".label");
  }
  result = runProgramOfPackage("kitti_to_bag", arguments);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("1 frames without scan or labels"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("3 frames and 2 objects"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace semantic_mht_slam
