#include "semantic_mht_slam/ros/ticket_mutex.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

using std::chrono::milliseconds;

TEST(TicketMutexTest, GuestWaitsForOneTurnOfAThreadThatAlwaysHoldsIt) {
  TicketMutex mutex;
  std::atomic<int> turns{0};
  std::atomic<bool> is_over{false};
  std::thread worker([&] {
    while (!is_over) {
      const std::lock_guard<TicketMutex> lock(mutex);
      ++turns;
      std::this_thread::sleep_for(milliseconds(5));
    }
  });
  while (turns == 0) std::this_thread::yield();
  for (int i = 0; i < 20; ++i) {
    const int before = turns;
    const std::lock_guard<TicketMutex> lock(mutex);
    EXPECT_LE(turns - before, 2);
  }
  is_over = true;
  worker.join();
}

TEST(TicketMutexTest, ExcludesOthers) {
  TicketMutex mutex;
  int count = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 1000; ++i) {
        const std::lock_guard<TicketMutex> lock(mutex);
        ++count;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(count, 4000);
}

}  // namespace
}  // namespace semantic_mht_slam
