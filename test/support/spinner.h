#pragma once

#include <memory>

#include <gtest/gtest.h>
#include <ros/ros.h>

namespace semantic_mht_slam {

/// Calls callbacks in a thread of its own while the tests of a program run, once it is one of its global environments.
class Spinner : public testing::Environment {
 public:
  void SetUp() override {
    spinner_ = std::make_unique<ros::AsyncSpinner>(1);
    spinner_->start();
  }
  void TearDown() override { spinner_.reset(); }

 private:
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

}  // namespace semantic_mht_slam
