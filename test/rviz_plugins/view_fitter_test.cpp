#include "../../src/rviz_plugins/view_fitter.h"

#include <memory>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

/// Views by their properties, as rviz's own have them: to make these takes a display.
std::unique_ptr<rviz::Property> viewFromAbove(const QString& target = "<Fixed Frame>") {
  auto view = std::make_unique<rviz::Property>("Current View");
  new rviz::Property("Target Frame", target, "", view.get());
  new rviz::Property("Scale", 10.0F, "", view.get());
  new rviz::Property("X", 0.0F, "", view.get());
  new rviz::Property("Y", 0.0F, "", view.get());
  return view;
}

std::unique_ptr<rviz::Property> orbit() {
  auto view = std::make_unique<rviz::Property>("Current View");
  new rviz::Property("Target Frame", "<Fixed Frame>", "", view.get());
  new rviz::Property("Distance", 60.0F, "", view.get());
  auto* focal_point = new rviz::Property("Focal Point", {}, "", view.get());
  for (const char* axis : {"X", "Y", "Z"}) new rviz::Property(axis, 0.0F, "", focal_point);
  return view;
}

float at(rviz::Property& place, const char* axis) {
  return place.subProp(axis)->getValue().toFloat();
}

TEST(ViewFitterTest, TheViewFromAboveGoesWhereTheVehicleIs) {
  ViewFitter fitter;
  const auto view = viewFromAbove();
  for (int i = 0; i < 1000; ++i) fitter.follow({0.1 * i, -1.0, 5.0}, *view);
  EXPECT_FLOAT_EQ(at(*view, "X"), 99.9F);
  EXPECT_FLOAT_EQ(at(*view, "Y"), -1.0F);
  EXPECT_FLOAT_EQ(at(*view, "Scale"), 10.0F) << "the scale is set by maps alone";
}

TEST(ViewFitterTest, TheOrbitTurnsAroundTheVehicle) {
  ViewFitter fitter;
  const auto view = orbit();
  fitter.follow({20.0, 30.0, 2.0}, *view);
  rviz::Property& focal_point = *view->subProp("Focal Point");
  EXPECT_FLOAT_EQ(at(focal_point, "X"), 20.0F);
  EXPECT_FLOAT_EQ(at(focal_point, "Y"), 30.0F);
  EXPECT_FLOAT_EQ(at(focal_point, "Z"), 2.0F);
}

TEST(ViewFitterTest, WhatTheUserMovedStaysMoved) {
  ViewFitter fitter;
  const auto view = viewFromAbove();
  fitter.follow({50.0, 0.0, 0.0}, *view);
  view->subProp("X")->setValue(at(*view, "X") + 7.0F);
  for (int i = 0; i <= 1000; ++i) fitter.follow({50.0 + 0.01 * i, 0.0, 0.0}, *view);
  EXPECT_FLOAT_EQ(at(*view, "X"), 67.0F);
  EXPECT_FLOAT_EQ(at(*view, "Y"), 0.0F);
}

TEST(ViewFitterTest, AnotherViewBeginsAtTheVehicle) {
  ViewFitter fitter;
  auto view = viewFromAbove();
  fitter.follow({50.0, 0.0, 0.0}, *view);
  view->subProp("X")->setValue(80.0F);
  view = viewFromAbove();
  fitter.follow({60.0, 0.0, 0.0}, *view);
  EXPECT_FLOAT_EQ(at(*view, "X"), 60.0F);
}

TEST(ViewFitterTest, AViewThatFollowsAFrameOfTfIsLeftToIt) {
  ViewFitter fitter;
  const auto view = viewFromAbove("base_link");
  fitter.follow({50.0, 0.0, 0.0}, *view);
  EXPECT_FLOAT_EQ(at(*view, "X"), 0.0F);
  view->subProp("Target Frame")->setValue("<Fixed Frame>");
  fitter.follow({51.0, 0.0, 0.0}, *view);
  EXPECT_FLOAT_EQ(at(*view, "X"), 51.0F);
}

TEST(ViewFitterTest, ViewsFromAPlaceOfTheirOwnStay) {
  ViewFitter fitter;
  rviz::Property walk("Current View");
  new rviz::Property("Target Frame", "<Fixed Frame>", "", &walk);
  auto* position = new rviz::Property("Position", {}, "", &walk);
  new rviz::Property("X", 1.0F, "", position);
  fitter.follow({50.0, 0.0, 0.0}, walk);
  EXPECT_FLOAT_EQ(at(*position, "X"), 1.0F);
}

TEST(ViewFitterTest, AMapFitsWithTheVehicleInTheMiddle) {
  SemanticMap map;
  map.landmarks.resize(1);
  EXPECT_FALSE(fittingScale(map, 800, 600)) << "a point has no size";
  map.landmarks.resize(2);
  map.landmarks[1].position.x = 300.0;
  map.landmarks[1].position.y = 400.0;
  const std::optional<double> scale = fittingScale(map, 800, 600);
  ASSERT_TRUE(scale);
  EXPECT_LT(*scale * 250.0, 300.0) << "half of the diagonal, in pixels";
  EXPECT_GT(*scale * 500.0, 300.0) << "and not smaller than need be";
}

}  // namespace
}  // namespace semantic_mht_slam
