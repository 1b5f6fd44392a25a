#include "pacer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace fiimap::sim {
namespace {

constexpr double kFast = 0.0;  // real-time factor
constexpr double kMaxLead = 0.1;
constexpr std::chrono::milliseconds kMoment{50};

/// Waits in a thread of its own.
class Waiting {
 public:
  Waiting(Pacer* pacer, double time)
      : thread_([this, pacer, time] {
          pacer->waitFor(time);
          is_over_ = true;
        }) {}
  ~Waiting() { thread_.join(); }

  bool isOver() const { return is_over_; }

 private:
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

TEST(PacerTest, WaitsForNobodyWhoWasNeverHeardOf) {
  Pacer pacer(kFast, kMaxLead, false);
  pacer.waitFor(1000.0);
}

TEST(PacerTest, WaitsForEachFollower) {
  Pacer pacer(kFast, kMaxLead, false);
  pacer.hear(Pacer::Follower::kCommands, 1.15);
  pacer.hear(Pacer::Follower::kPlanner, 1.0);
  pacer.hear(Pacer::Follower::kMap, 1.0);
  pacer.waitFor(1.09);
  Waiting waiting(&pacer, 1.2);
  std::this_thread::sleep_for(kMoment);
  EXPECT_FALSE(waiting.isOver());
  pacer.hear(Pacer::Follower::kPlanner, 1.19);
  std::this_thread::sleep_for(kMoment);
  EXPECT_FALSE(waiting.isOver());
  pacer.hear(Pacer::Follower::kMap, 1.15);  // and the destructor joins
}

TEST(PacerTest, GoesOnWhenAFollowerIsSilent) {
  Pacer pacer(kFast, kMaxLead, false);
  pacer.hear(Pacer::Follower::kMap, 1.0);
  pacer.waitFor(5.0);  // returns after its patience
}

TEST(PacerTest, StopsWaitingAtOnce) {
  constexpr double kSlow = 1e-6;
  Pacer pacer(kSlow, kMaxLead, false);
  Waiting waiting(&pacer, 1.0);
  std::this_thread::sleep_for(kMoment);
  EXPECT_FALSE(waiting.isOver());
  pacer.stop();
}

}  // namespace
}  // namespace fiimap::sim
