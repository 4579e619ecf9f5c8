#include "semantic_mht_slam/perception/image_extractor.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/images/label_image_file.h"
#include "semantic_mht_slam/perception/image_blobs.h"

#include "support/expect_input_error.h"
#include "support/extraction_classes.h"
#include "support/scans.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const ClassTable kClasses = makeExtractionClasses();
const LabelMap kLabels = makeExtractionLabels();
const ExtractionConfig kConfig{kClasses};

LabelImage blank(int width_px = 640, int height_px = 360) {
  return {width_px, height_px,
          std::vector<std::uint16_t>(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 0)};
}

void fill(LabelImage& image, int left, int top, int right, int bottom, std::uint16_t label) {
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      image.labels[static_cast<std::size_t>(row * image.width_px + column)] = label;
    }
  }
}

/// Sensor frame: x forward, y left, z up; the camera sits at its origin and looks along x.
Camera makeCamera() {
  Camera camera;
  camera.projection << 500.0, 0.0, 320.0, 0.0, 0.0, 500.0, 180.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  camera.T_camera_sensor.rotation =
      Eigen::Quaterniond((Eigen::Matrix3d() << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0).finished());
  return camera;
}

/// Marks where a box is seen, `slack_px` wider than it is, as masks are.
void mark(LabelImage& image, const Eigen::Vector3d& center_m, const Eigen::Vector3d& size_m, std::uint16_t label,
          int slack_px) {
  const Camera camera = makeCamera();
  Eigen::AlignedBox2d box;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    box.extend(*camera.project(center_m + side.cwiseProduct(size_m)));
  }
  const auto inside = [](double at, int slack, int last) { return std::clamp(static_cast<int>(at) + slack, 0, last); };
  fill(image, inside(box.min().x(), -slack_px, 639), inside(box.min().y(), -slack_px, 359),
       inside(box.max().x(), slack_px, 639), inside(box.max().y(), slack_px, 359), label);
}

TEST(ImageExtractorTest, WallBehindAPoleThatBleedsIntoItsMaskDoesNotPullItsCentroid) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    LabelledCloud cloud;
    addBox(cloud, {12.0, 1.0, 0.5}, {0.2, 0.2, 3.0}, 80, 0, rng);
    addBox(cloud, {20.0, 0.0, 1.0}, {0.1, 20.0, 5.0}, 20000, 0, rng);
    LabelImage image = blank();
    fill(image, 0, 0, 639, 359, kWallLabel);
    mark(image, {12.0, 1.0, 0.5}, {0.2, 0.2, 3.0}, kPoleLabel, 2);
    const Extraction extraction = extractObjects(cloud, image, makeCamera(), kLabels, kConfig);
    ASSERT_GE(extraction.objects.size(), 2U) << "seed " << seed;
    EXPECT_EQ(extraction.objects[1].detection.class_index, kWall) << "a second pole, seed " << seed;
    const Detection& pole = extraction.objects[0].detection;
    EXPECT_EQ(pole.class_index, kPole);
    EXPECT_LT((pole.position_m - Eigen::Vector3d(12.0, 1.0, 0.5)).norm(), 0.3) << "seed " << seed;
    EXPECT_EQ(pole.points, 80);
  }
}

TEST(ImageExtractorTest, CarsInARowThatAreOneBlobAreObjectsOfTheirOwn) {
  Rng rng(2);
  LabelledCloud cloud;
  LabelImage image = blank();
  const Eigen::Vector3d size(4.0, 1.8, 1.5);
  for (const double x : {8.0, 14.0, 20.0}) {
    addBox(cloud, {x, 3.0, -1.0}, size, 600, 0, rng);
    mark(image, {x, 3.0, -1.0}, size, kCarLabel, 0);
  }
  mark(image, {14.0, 3.0, -1.0}, {12.0, 1.8, 1.0}, kCarLabel, 0);
  const ImageBlobs blobs = findBlobs(image, kLabels, kClasses.size(), kConfig.image);
  ASSERT_EQ(blobs.class_of_blob.size(), 1U) << "the test wants one blob";
  const Extraction extraction = extractObjects(cloud, image, makeCamera(), kLabels, kConfig);
  ASSERT_EQ(extraction.objects.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(
        (extraction.objects[i].detection.position_m - Eigen::Vector3d(8.0 + 6.0 * static_cast<double>(i), 3.0, -1.0))
            .norm(),
        0.3);
  }
}

TEST(ImageExtractorTest, DistanceIsMeasuredAlongTheRayAndNotAlongTheOpticalAxis) {
  Rng rng(3);
  LabelledCloud cloud;
  const Eigen::Vector3d center(8.0, 4.5, 0.0);  // 29 degrees beside the axis
  addBox(cloud, center, {0.2, 0.2, 2.0}, 100, 0, rng);
  LabelImage image = blank();
  mark(image, center, {0.2, 0.2, 2.0}, kPoleLabel, 1);
  const Extraction extraction = extractObjects(cloud, image, makeCamera(), kLabels, kConfig);
  ASSERT_EQ(extraction.objects.size(), 1U);
  EXPECT_LT((extraction.objects[0].detection.position_m - center).norm(), 0.2);
}

TEST(ImageExtractorTest, PointsBehindTheCameraAndOutsideTheImageBelongToNothing) {
  Rng rng(4);
  LabelledCloud cloud;
  addBox(cloud, {-12.0, -1.0, 0.0}, {0.2, 0.2, 3.0}, 80, 0, rng);
  addBox(cloud, {5.0, 30.0, 0.0}, {0.2, 0.2, 3.0}, 80, 0, rng);
  LabelImage image = blank();
  fill(image, 0, 0, 639, 359, kPoleLabel);
  EXPECT_TRUE(extractObjects(cloud, image, makeCamera(), kLabels, kConfig).objects.empty());
}

TEST(ImageBlobsTest, BlobsAreComponentsOfTheClosedMaskWithoutSpecks) {
  LabelImage image = blank();
  fill(image, 100, 100, 103, 200, kPoleLabel);
  fill(image, 100, 205, 103, 300, kPoleLabel);  // beyond a gap of 4 rows
  fill(image, 300, 100, 303, 200, kPoleLabel);
  fill(image, 500, 100, 501, 101, kPoleLabel);  // a speck
  fill(image, 300, 210, 400, 300, kCarLabel);
  const ImageBlobs blobs = findBlobs(image, kLabels, kClasses.size(), kConfig.image);
  EXPECT_EQ(blobs.class_of_blob, (std::vector<ClassIndex>{kPole, kPole, kCar}));
  const auto at = [&](int column, int row) {
    return blobs.blob_of_pixel[static_cast<std::size_t>(row * 640 + column)];
  };
  EXPECT_EQ(at(101, 150), at(101, 250));
  EXPECT_NE(at(101, 150), at(301, 150));
  EXPECT_EQ(at(101, 202), ImageBlobs::kNone) << "a pixel of the gap";
  EXPECT_EQ(at(500, 100), ImageBlobs::kNone);
  EXPECT_EQ(blobs.class_of_blob[static_cast<std::size_t>(at(350, 250))], kCar);
  EXPECT_TRUE(blobs.is_rim[210 * 640 + 300]);
  EXPECT_FALSE(blobs.is_rim[250 * 640 + 350]);
}

TEST(ImageBlobsTest, UnknownLabelsAreCountedInPixelsAndAWrongCountOfPixelsThrows) {
  LabelImage image = blank(20, 10);
  fill(image, 0, 0, 4, 1, kUnknownLabel);
  EXPECT_EQ(extractObjects(LabelledCloud{}, image, makeCamera(), kLabels, kConfig).unknown_labels,
            (std::map<std::uint16_t, std::size_t>{{kUnknownLabel, 10U}}));
  image.labels.pop_back();
  EXPECT_THROW(findBlobs(image, kLabels, kClasses.size(), kConfig.image), std::invalid_argument);
  EXPECT_TRUE(findBlobs(LabelImage{}, kLabels, kClasses.size(), kConfig.image).class_of_blob.empty());
}

TEST(LabelImageFileTest, ImageComesBackAsWrittenAndOthersAreRefused) {
  const TemporaryFolder folder;
  LabelImage image = blank(30, 20);
  fill(image, 3, 4, 5, 6, 40000);
  writeLabelImage(folder / "labels.png", image);
  const LabelImage read = readLabelImage(folder / "labels.png");
  EXPECT_EQ(read.width_px, 30);
  EXPECT_EQ(read.height_px, 20);
  EXPECT_EQ(read.labels, image.labels);
  expectInputError([&] { readLabelImage(folder / "missing.png"); }, {"missing.png"});
  expectInputError([&] { readLabelImage(folder.path()); }, {"no such file"});
  expectInputError([&] { writeLabelImage(folder / "no/such/folder.png", image); }, {"folder.png"});
}

}  // namespace
}  // namespace semantic_mht_slam
