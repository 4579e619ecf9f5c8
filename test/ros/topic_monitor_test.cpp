#include "semantic_mht_slam/ros/topic_monitor.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(TopicMonitorTest, RateIsThatOfTheMessagesAndFallsWhenTheyStop) {
  TopicMonitor monitor;
  for (int i = 0; i < 30; ++i) monitor.arrived(i, std::nullopt, 0.1 * i);
  EXPECT_NEAR(monitor.status(2.9).rate_hz, 10.0, 1e-9);
  for (int i = 30; i < 300; ++i) monitor.arrived(i, std::nullopt, 0.1 * i);
  EXPECT_NEAR(monitor.status(29.95).rate_hz, 10.0, 0.11);
  EXPECT_EQ(monitor.status(60.0).rate_hz, 0.0);
  EXPECT_NEAR(*monitor.status(60.0).silent_s, 30.1, 1e-9);
  EXPECT_EQ(monitor.status(60.0).received, 300U);
}

/// Numbers [begin, end).
void arrive(SequenceGaps& gaps, const std::string& publisher, std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t number = begin; number < end; ++number) gaps.arrived(publisher, number);
}

TEST(SequenceGapsTest, GapsOfAPublisherAreCountedOnceTheNextMessageGoesOn) {
  SequenceGaps gaps;
  arrive(gaps, "a", 500, 520);
  gaps.arrived("a", 525);
  EXPECT_EQ(gaps.lost(), 0U);
  gaps.arrived("a", 526);
  EXPECT_EQ(gaps.lost(), 5U);
  arrive(gaps, "b", 7, 27);
  arrive(gaps, "b", 28, 30);
  arrive(gaps, "a", 527, 540);
  EXPECT_EQ(gaps.lost(), 6U) << "each publisher counts for itself";
}

TEST(SequenceGapsTest, OneThatBeginsAgainHasLostNothing) {
  SequenceGaps gaps;
  arrive(gaps, "a", 500, 520);
  arrive(gaps, "a", 0, 20);
  arrive(gaps, "a", 21, 23);
  EXPECT_EQ(gaps.lost(), 1U);
}

TEST(SequenceGapsTest, WhatIsThinnedWithoutNumbersOrOfSeveralPublishersHasNoGaps) {
  SequenceGaps gaps;
  for (std::uint32_t i = 0; i < 100; ++i) {
    gaps.arrived("thinned", 10 * i);
    gaps.arrived("none", 0);
    gaps.arrived("two of a bag", i);
    if (i % 20 == 0) gaps.arrived("two of a bag", 100000 + i);
  }
  EXPECT_EQ(gaps.lost(), 0U);
}

}  // namespace
}  // namespace semantic_mht_slam
