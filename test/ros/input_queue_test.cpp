#include "semantic_mht_slam/ros/input_queue.h"

#include <thread>

#include <boost/make_shared.hpp>
#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

InputMessage odometryWithSequence(std::uint32_t sequence) {
  auto message = boost::make_shared<nav_msgs::Odometry>();
  message->header.seq = sequence;
  return nav_msgs::OdometryConstPtr(message);
}

std::uint32_t sequenceOf(const InputMessage& message) {
  return std::get<nav_msgs::OdometryConstPtr>(message)->header.seq;
}

TEST(InputQueueTest, FullQueueDropsTheOldestAndCountsIt) {
  InputQueue queue(3);
  for (std::uint32_t i = 0; i < 5; ++i) queue.push(odometryWithSequence(i));
  EXPECT_EQ(queue.dropped(), 2U);
  for (std::uint32_t i = 2; i < 5; ++i) EXPECT_EQ(sequenceOf(*queue.pop()), i);
}

TEST(InputQueueTest, ClosingWakesAWaitingWorker) {
  InputQueue queue(3);
  bool got_message = true;
  std::thread worker([&] { got_message = queue.pop().has_value(); });
  queue.close();
  worker.join();
  EXPECT_FALSE(got_message);
}

}  // namespace
}  // namespace semantic_mht_slam
