#include "semantic_mht_slam/ros/input_queue.h"

#include <atomic>
#include <chrono>
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

InputMessage objectsWithSequence(std::uint32_t sequence) {
  auto message = boost::make_shared<SemanticObjectArray>();
  message->header.seq = sequence;
  return SemanticObjectArrayConstPtr(message);
}

InputMessage fixWithSequence(std::uint32_t sequence) {
  auto message = boost::make_shared<sensor_msgs::NavSatFix>();
  message->header.seq = sequence;
  return sensor_msgs::NavSatFixConstPtr(message);
}

constexpr std::chrono::hours kForever(1);

std::uint32_t sequenceOf(const InputMessage& message) {
  return std::visit([](const auto& pointer) { return pointer->header.seq; }, message);
}

TEST(InputQueueTest, FullQueueDropsTheOldestAndCountsIt) {
  InputQueue queue(3, kForever);
  for (std::uint32_t i = 0; i < 5; ++i) queue.push(odometryWithSequence(i));
  EXPECT_EQ(queue.droppedOdometry(), 2U);
  for (std::uint32_t i = 2; i < 5; ++i) EXPECT_EQ(sequenceOf(*queue.pop()), i);
}

TEST(InputQueueTest, FullQueueDropsObjectsBeforeOdometry) {
  InputQueue queue(4, kForever);
  for (std::uint32_t i = 0; i < 6; i += 2) {
    queue.push(odometryWithSequence(i));
    queue.push(objectsWithSequence(i + 1));
  }
  EXPECT_EQ(queue.droppedOdometry(), 0U);
  EXPECT_EQ(queue.droppedObjects(), 2U) << "the oldest two";
  for (const std::uint32_t i : {0U, 2U, 4U, 5U}) EXPECT_EQ(sequenceOf(*queue.pop()), i);
}

TEST(InputQueueTest, FullQueueDropsFixesBeforeObjectsAndOdometry) {
  InputQueue queue(4, kForever);
  queue.push(objectsWithSequence(0));
  queue.push(fixWithSequence(1));
  queue.push(odometryWithSequence(2));
  queue.push(fixWithSequence(3));
  for (std::uint32_t i = 4; i < 6; ++i) queue.push(odometryWithSequence(i));
  EXPECT_EQ(queue.droppedFixes(), 2U);
  EXPECT_EQ(queue.droppedObjects(), 0U);
  queue.push(odometryWithSequence(6));
  EXPECT_EQ(queue.droppedObjects(), 1U);
  EXPECT_EQ(queue.droppedOdometry(), 0U);
  for (const std::uint32_t i : {2U, 4U, 5U, 6U}) EXPECT_EQ(sequenceOf(*queue.pop()), i);
}

TEST(InputQueueTest, ObjectsThatWaitedForTooLongAreDroppedAndOdometryIsNot) {
  InputQueue queue(10, std::chrono::milliseconds(20));
  queue.push(objectsWithSequence(0));
  queue.push(odometryWithSequence(1));
  queue.push(objectsWithSequence(2));
  std::this_thread::sleep_for(std::chrono::milliseconds(40));
  queue.push(objectsWithSequence(3));
  EXPECT_EQ(sequenceOf(*queue.pop()), 1U);
  EXPECT_EQ(sequenceOf(*queue.pop()), 3U);
  EXPECT_EQ(queue.droppedObjects(), 2U);
  EXPECT_EQ(queue.droppedOdometry(), 0U);
}

TEST(InputQueueTest, ClosingWakesAWaitingWorker) {
  InputQueue queue(3, kForever);
  bool got_message = true;
  std::thread worker([&] { got_message = queue.pop().has_value(); });
  queue.close();
  worker.join();
  EXPECT_FALSE(got_message);
}

TEST(InputQueueTest, WaitingEndsWhenAllThatWasThereIsHandledAndNotBefore) {
  InputQueue queue(3, kForever);
  for (std::uint32_t i = 0; i < 5; ++i) queue.push(odometryWithSequence(i));  // two are dropped
  std::atomic<bool> is_waiting{false};
  std::atomic<bool> is_handled{false};
  std::thread waiting([&] {
    queue.waitUntilHandled([&] { return is_waiting = true; });
    is_handled = true;
  });
  while (!is_waiting) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (std::uint32_t i = 0; i < 3; ++i) {
    queue.pop();
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_FALSE(is_handled) << "message " << i << " is still being handled";
  }
  queue.push(odometryWithSequence(5));  // came later: nobody waits for it
  queue.pop();
  waiting.join();
  EXPECT_TRUE(is_handled);
}

TEST(InputQueueTest, WaitingForAnEmptyQueueEndsAtOnce) {
  InputQueue queue(3, kForever);
  bool was_asked = false;
  queue.waitUntilHandled([&] { return was_asked = true; });
  EXPECT_FALSE(was_asked);
}

TEST(InputQueueTest, WaitingIsGivenUpWhenTheQueueIsClosedOrNobodyWantsToWait) {
  InputQueue queue(3, kForever);
  queue.push(odometryWithSequence(0));
  int asked = 0;
  queue.waitUntilHandled([&] { return ++asked < 3; });
  EXPECT_EQ(asked, 3);
  std::thread waiting([&] { queue.waitUntilHandled([] { return true; }); });
  queue.close();
  waiting.join();
}

}  // namespace
}  // namespace semantic_mht_slam
