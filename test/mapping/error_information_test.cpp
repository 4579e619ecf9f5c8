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
  StateArchive reading(writing.written());
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

}  // namespace
}  // namespace semantic_mht_slam
