#include <gtest/gtest.h>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/mapping/variance_components.h"

#include "support/expect_input_error.h"

namespace semantic_mht_slam {
namespace {

/// Two errors and a nuisance that one measurement joins.
ErrorInformation goodInformation() {
  ErrorInformation information;
  information.matrix = Eigen::Matrix2d::Identity();
  information.vector = Eigen::Vector2d(0.1, -0.2);
  information.design = Eigen::Vector2d(1.0, 0.5);
  information.effect = Eigen::Vector2d(0.3, 0.4);
  information.coupling = Eigen::Vector2d(0.5, 0.5);
  information.nuisance_matrix = Eigen::MatrixXd::Identity(1, 1);
  information.nuisance_vector = Eigen::VectorXd::Ones(1);
  return information;
}

void read(ErrorInformation information) {
  StateArchive writing;
  writing(information);
  const std::string bytes = writing.written();
  StateArchive reading(bytes);
  ErrorInformation again;
  reading(again);
  reading.requireEnd();
}

TEST(ErrorInformationTest, GoodOneIsReadAgain) {
  EXPECT_NO_THROW(read(goodInformation()));
}

/// From a map file: it made covariances of the odometry negative with the next submap.
TEST(ErrorInformationTest, NegativeInformationOfErrorsAndNuisancesTogetherIsRefused) {
  ErrorInformation information = goodInformation();
  information.nuisance_matrix(0, 0) = -1.0;
  expectInputError([&] { read(information); }, {"information is negative"});
  information = goodInformation();
  information.coupling(0, 0) = 10.0;
  expectInputError([&] { read(information); }, {"information is negative"});
  information = goodInformation();
  information.matrix(0, 0) = -1.0;
  expectInputError([&] { read(information); }, {"information is negative"});
}

/// From a map file: it made the systematic errors of the odometry 1e34, and landmarks infinite with the next submap.
TEST(ErrorInformationTest, WhatNoResidualsGiveIsRefused) {
  ErrorInformation information = goodInformation();
  information.vector(0) = 1e30;
  expectInputError([&] { read(information); }, {"no residuals give"});
  information = goodInformation();
  information.nuisance_vector(0) = -1e30;
  expectInputError([&] { read(information); }, {"no residuals give"});
  information = goodInformation();
  information.vector(1) = 1e4;  // ten thousand deviations
  EXPECT_NO_THROW(read(information));
}

}  // namespace
}  // namespace semantic_mht_slam
