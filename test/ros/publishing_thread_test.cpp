#include "publishing_thread.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace fiimap {
namespace {

void waitFor(const std::atomic<int>& count, int value) {
  while (count < value) std::this_thread::yield();
}

TEST(PublishingThreadTest, AnotherRateHoldsInTheMiddleOfAPeriod) {
  constexpr double kSlow = 0.001, kFast = 1000.0;  // Hz
  std::atomic<int> published{0};
  PublishingThread thread(kSlow, [&published] { ++published; });
  thread.wake();
  waitFor(published, 1);
  thread.wake();
  thread.setRate(kFast);
  waitFor(published, 2);  // a thousand seconds later, if it did not hold
  thread.wake();
  waitFor(published, 3);
}

TEST(PublishingThreadTest, StopsInTheMiddleOfAPeriod) {
  std::atomic<int> published{0};
  PublishingThread thread(0.001, [&published] { ++published; });
  thread.wake();
  waitFor(published, 1);
  thread.wake();
  thread.stop();
  EXPECT_EQ(published, 1);
}

}  // namespace
}  // namespace fiimap
