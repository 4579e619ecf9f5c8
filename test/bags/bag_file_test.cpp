#include "semantic_mht_slam/bags/bag_file.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <std_msgs/Time.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/result_files.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/recordings.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

constexpr Stamp kOrigin = 1000000000;

class BagFileTest : public ::testing::Test {
 protected:
  std::string write(const Recording& recording) {
    writeBag(path_, recording, classes_, {}, {}, kOrigin);
    return path_;
  }

  void expectRefused(const std::vector<std::string>& parts) {
    expectInputError([&] { readBag(path_, classes_, {}, {}); }, parts);
  }

  const ClassTable classes_ = makeTwoClasses();
  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "drive.bag";
};

void expectEqual(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].stamp, b[i].stamp);
    EXPECT_EQ(a[i].T_world_base.matrix(), b[i].T_world_base.matrix());
  }
}

TEST_F(BagFileTest, RecordingComesBackBitForBit) {
  const Recording recording = makeCircleRecording(25);
  const Recording read = readBag(write(recording), classes_, {}, {});
  expectEqual(read.odometry, recording.odometry);
  expectEqual(read.ground_truth, recording.ground_truth);
  ASSERT_TRUE(read.T_base_cam0);
  EXPECT_EQ(read.T_base_cam0->matrix(), recording.T_base_cam0->matrix());
  ASSERT_EQ(read.detector_frames.size(), recording.detector_frames.size());
  for (std::size_t i = 0; i < read.detector_frames.size(); ++i) {
    EXPECT_EQ(read.detector_frames[i].stamp, recording.detector_frames[i].stamp);
    const Detections& actual = read.detector_frames[i].detections;
    const Detections& expected = recording.detector_frames[i].detections;
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t row = 0; row < actual.size(); ++row) {
      EXPECT_EQ(actual[row].class_index, expected[row].class_index);
      EXPECT_EQ(actual[row].position_m, expected[row].position_m);
      EXPECT_EQ(actual[row].score, expected[row].score);
      EXPECT_EQ(actual[row].points, expected[row].points);
      EXPECT_EQ(actual[row].is_moving, expected[row].is_moving);
      EXPECT_EQ(actual[row].cov_m2, expected[row].cov_m2);
      EXPECT_EQ(actual[row].size_m, expected[row].size_m);
      EXPECT_EQ(actual[row].row, expected[row].row);
    }
  }
}

TEST_F(BagFileTest, SameRecordingGivesTheSameBytes) {
  const Recording recording = makeCircleRecording(10);
  const std::string first = readFile(write(recording));
  EXPECT_EQ(readFile(write(recording)), first);
}

TEST_F(BagFileTest, TruncatedForeignAndMissingFilesAreRefused) {
  expectRefused({"drive.bag", "no such file"});
  const std::string content = readFile(write(makeCircleRecording(25)));
  writeFileAtomically(path_, content.substr(0, content.size() / 2));
  expectRefused({"drive.bag", "truncated"});
  writeFileAtomically(path_, "this is no bag");
  expectRefused({"drive.bag", "no bag"});
  writeFileAtomically(path_, "");
  expectRefused({"drive.bag", "no bag"});
}

TEST_F(BagFileTest, BagsWithoutWhatIsNeededAreRefusedByTopic) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.write("/odometry", ros::Time(1.0), std_msgs::String());
  }
  expectRefused({"/odometry", "std_msgs/String", "nav_msgs/Odometry"});
  Recording recording = makeCircleRecording(5);
  recording.detector_frames.clear();
  write(recording);
  expectRefused({"no messages on /objects", "/odometry (nav_msgs/Odometry)", "/tf_static (tf2_msgs/TFMessage)"});
}

TEST_F(BagFileTest, AnOriginOfTimeBeyondTheStampsIsRefusedByTopic) {
  const Recording recording = makeCircleRecording(5);
  write(recording);
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Append);
    std_msgs::Time origin;
    origin.data = ros::Time(4000.0);
    bag.write("/time_origin", ros::Time(2.0), origin);
  }
  expectRefused({"drive.bag", "topic /time_origin says 4000.000 s", "later than /o", "stamped 1.0"});
  writeBag(path_, recording, classes_, {}, {}, recording.odometry.front().stamp + kOrigin);
  EXPECT_EQ(readBag(path_, classes_, {}, {}).odometry.size(), 5U) << "right at the first stamp";
}

TEST_F(BagFileTest, ObjectsOfASensorAreMovedToTheBaseFrame) {
  const Pose T_base_lidar{expRotation({0.0, 0.0, M_PI / 2.0}), {1.0, 0.0, 0.5}};
  Detection detection;
  detection.position_m = {2.0, 0.0, 0.0};
  detection.cov_m2 = Eigen::Matrix3d(Eigen::Vector3d(0.04, 0.01, 0.09).asDiagonal());
  const SemanticObjectArray message = toMessage(kOrigin, "lidar", {detection}, classes_);
  std::size_t unknown = 0;
  const Detections moved = fromMessage(message, classes_, T_base_lidar, unknown);
  EXPECT_LT((moved[0].position_m - Eigen::Vector3d(1.0, 2.0, 0.5)).norm(), 1e-12);
  EXPECT_LT((moved[0].cov_m2->diagonal() - Eigen::Vector3d(0.01, 0.04, 0.09)).norm(), 1e-12);
  EXPECT_EQ(unknown, 0U);
  const SemanticObjectArray empty = toMessage(kOrigin, "lidar", {Detection{}}, classes_);
  EXPECT_TRUE(fromMessage(empty, classes_, T_base_lidar, unknown)[0].position_m.isZero(0.0))
      << "a position that was left empty is no object where the sensor is";
}

TEST_F(BagFileTest, UnwritablePlacesLeaveNothingBehind) {
  expectInputError([&] { writeBag(folder_ / "none/drive.bag", makeCircleRecording(3), classes_, {}, {}, kOrigin); },
                   {"none/drive.bag"});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(BagFileTest, BagOfAKittiSequenceGivesTheSameBytesAsItsFolder) {
  const auto kitti = kittiFolder("07");
  if (!kitti) GTEST_SKIP() << "SEMANTIC_MHT_SLAM_DATA is not set";
  const ClassTable classes = loadClassTable(SystemConfig{}, "");
  const Recording from_folder =
      toRecording(readDataset({*kitti, "objects_semireal.csv", "odometry/lo_simple.txt"}, classes));
  writeBag(path_, from_folder, classes, {}, {}, kOrigin);
  const Recording from_bag = readBag(path_, classes, {}, {});
  for (const auto& [recording, name] : {std::pair(&from_folder, "folder"), std::pair(&from_bag, "bag")}) {
    prepareOutputFolder(folder_ / name);
    const RunResult result = runOffline(*recording, SlamConfig{}, classes, [](std::size_t, std::size_t) {});
    writeResultFiles(folder_ / name, *recording, result, SystemConfig{}, classes);
  }
  for (const char* file : {"trajectory.txt", "trajectory.tum", "associations.csv", "landmarks.csv", "config.yaml"}) {
    EXPECT_EQ(readFile(folder_ / "bag" + "/" + file), readFile(folder_ / "folder" + "/" + file)) << file;
  }
}

}  // namespace
}  // namespace semantic_mht_slam
