#include "semantic_mht_slam/perception/segmentation_network.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"
#include "support/tiny_network.h"

namespace semantic_mht_slam {
namespace {

class SegmentationNetworkTest : public ::testing::Test {
 protected:
  SegmentationNetworkTest() {
    config_.model = folder_ / "tiny.onnx";
    writeFileAtomically(config_.model, toOnnx(makeColorNetwork()));
  }

  /// An image of random pure colours and their ids.
  void makeImage(int width_px, int height_px, int channels, bool is_red_first) {
    Rng rng(1);
    const auto pixels = static_cast<std::size_t>(width_px * height_px);
    bytes_.assign(pixels * static_cast<std::size_t>(channels), 10);
    ids_.clear();
    for (std::size_t i = 0; i < pixels; ++i) {
      const auto id = static_cast<std::uint16_t>(rng.index(3));
      ids_.push_back(id);
      bytes_[i * static_cast<std::size_t>(channels) + (is_red_first ? id : 2U - id)] = 200;
    }
    view_ = {width_px, height_px, channels, is_red_first, static_cast<std::size_t>(width_px * channels), bytes_.data()};
  }

  const TemporaryFolder folder_;
  SegmentationConfig config_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint16_t> ids_;
  ImageView view_;
};

TEST_F(SegmentationNetworkTest, EveryPixelGetsTheClassOfItsBestScoreInAnyOrderOfColours) {
  SegmentationNetwork network(config_);
  for (const int channels : {3, 4}) {
    for (const bool is_red_first : {true, false}) {
      makeImage(40, 30, channels, is_red_first);
      const LabelImage labels = network.segment(view_);
      EXPECT_EQ(labels.width_px, 40);
      EXPECT_EQ(labels.height_px, 30);
      EXPECT_EQ(labels.labels, ids_) << channels << " channels, red first " << is_red_first;
    }
  }
}

TEST_F(SegmentationNetworkTest, ANetworkThatWantsBlueFirstGetsItsChannelsReversed) {
  config_.is_red_first = false;
  SegmentationNetwork network(config_);
  makeImage(40, 30, 3, true);
  std::transform(ids_.begin(), ids_.end(), ids_.begin(),
                 [](std::uint16_t id) { return static_cast<std::uint16_t>(2 - id); });
  EXPECT_EQ(network.segment(view_).labels, ids_);
}

TEST_F(SegmentationNetworkTest, MeanOfEachColourIsSubtractedFromThatColour) {
  config_.mean_green = 255.0;
  SegmentationNetwork network(config_);
  makeImage(40, 30, 3, true);
  const LabelImage labels = network.segment(view_);
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    EXPECT_EQ(labels.labels[i], ids_[i] == 1 ? 0 : ids_[i]) << "green must never win";
  }
}

TEST_F(SegmentationNetworkTest, EachColourIsDividedByItsDeviation) {
  for (const bool is_red_first : {true, false}) {
    config_.is_red_first = is_red_first;
    config_.stddev_red = 1000.0;
    SegmentationNetwork network(config_);
    makeImage(40, 30, 3, true);
    const LabelImage labels = network.segment(view_);
    const std::uint16_t red = is_red_first ? 0 : 2;  // channel of the network that no pixel is brightest in
    for (const std::uint16_t label : labels.labels) EXPECT_NE(label, red);
  }
}

TEST_F(SegmentationNetworkTest, LabelsHaveTheSizeOfTheImageWhateverTheNetworkWants) {
  config_.input_width_px = 16;
  config_.input_height_px = 8;
  SegmentationNetwork network(config_);
  makeImage(64, 32, 3, true);
  std::fill(bytes_.begin(), bytes_.end(), std::uint8_t{0});
  for (std::size_t i = 0; i < bytes_.size(); i += 3)
    bytes_[i + (i / 3 % 64 < 32 ? 2 : 1)] = 200;  // left blue, right green
  const LabelImage labels = network.segment(view_);
  ASSERT_EQ(labels.labels.size(), 64U * 32U);
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 64; ++column) EXPECT_EQ(labels.at(column, row), column < 32 ? 2 : 1);
  }
}

TEST_F(SegmentationNetworkTest, FilesThatAreNoNetworkAndImagesThatAreNoneAreRefused) {
  expectInputError([] { SegmentationNetwork network({}); }, {"no such file"});
  SegmentationConfig config;
  config.model = folder_ / "broken.onnx";
  writeFileAtomically(config.model, "this is no network");
  expectInputError([&] { SegmentationNetwork network(config); }, {"broken.onnx"});
  SegmentationNetwork network(config_);
  EXPECT_THROW(network.segment({}), std::invalid_argument);
  makeImage(8, 8, 3, true);
  view_.channels = 2;
  EXPECT_THROW(network.segment(view_), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
