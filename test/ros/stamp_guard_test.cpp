#include "fiimap/ros/stamp_guard.h"

#include <vector>

#include "messages.h"

namespace fiimap {
namespace {

using Verdict = StampVerdict;
using Verdicts = std::vector<StampVerdict>;

/// Verdicts on stamps one after the other.
Verdicts judge(const std::vector<double>& stamps, double other = 0.0) {
  StampGuard guard;
  Verdicts verdicts;
  for (const double seconds : stamps) {
    verdicts.push_back(guard.judge(at(seconds), other > 0.0 ? at(other) : ros::Time()));
    if (verdicts.back() == Verdict::kJumpBack) guard.clear();
  }
  return verdicts;
}

TEST(StampGuardTest, BelievesStampsInOrderAndALittleLate) {
  EXPECT_EQ(judge({5.0, 5.1, 4.2, 6.0, 6.9}), Verdicts(5, Verdict::kGood));
}

TEST(StampGuardTest, DoubtsASingleStampAhead) {
  EXPECT_EQ(judge({5.0, 900.0, 5.1, 5.2}),
            (Verdicts{Verdict::kGood, Verdict::kDoubtful, Verdict::kGood, Verdict::kGood}));
}

TEST(StampGuardTest, DoubtsASingleStampBehind) {
  EXPECT_EQ(judge({5.0, 1.0, 5.1, 5.2}),
            (Verdicts{Verdict::kGood, Verdict::kDoubtful, Verdict::kGood, Verdict::kGood}));
}

TEST(StampGuardTest, BelievesTheSecondStampAhead) {
  EXPECT_EQ(judge({5.0, 9.0, 9.1, 9.2}),
            (Verdicts{Verdict::kGood, Verdict::kDoubtful, Verdict::kLeap, Verdict::kGood}));
}

TEST(StampGuardTest, BelievesTheSecondStampBehind) {
  EXPECT_EQ(judge({5.0, 1.0, 1.1, 1.2}),
            (Verdicts{Verdict::kGood, Verdict::kDoubtful, Verdict::kJumpBack, Verdict::kGood}));
}

TEST(StampGuardTest, StraysInOppositeDirectionsDoNotConfirmEachOther) {
  EXPECT_EQ(judge({5.0, 900.0, 1.0, 5.1}),
            (Verdicts{Verdict::kGood, Verdict::kDoubtful, Verdict::kDoubtful, Verdict::kGood}));
}

TEST(StampGuardTest, APauseAfterAStrayIsNotItsConfirmation) {
  EXPECT_EQ(judge({5.0, 900.0, 9.0, 9.1}),
            (Verdicts{Verdict::kGood, Verdict::kDoubtful, Verdict::kDoubtful, Verdict::kLeap}));
}

TEST(StampGuardTest, AnotherTopicConfirmsAPauseAtOnce) {
  EXPECT_EQ(judge({5.0, 9.0, 9.5}, 8.5), Verdicts(3, Verdict::kGood));
}

TEST(StampGuardTest, AnotherTopicTellsOfAFirstStampAhead) {
  EXPECT_EQ(judge({160.0, 100.1, 100.2}, 100.0),
            (Verdicts{Verdict::kDoubtful, Verdict::kGood, Verdict::kGood}));
  EXPECT_EQ(judge({160.0, 160.1}, 100.0), (Verdicts{Verdict::kDoubtful, Verdict::kLeap}));
}

TEST(StampGuardTest, TheVeryFirstStampIsBelieved) {
  EXPECT_EQ(judge({160.0, 160.1}), (Verdicts{Verdict::kGood, Verdict::kGood}));
}

TEST(StampGuardTest, AnotherTopicConfirmsADoubtfulStampToo) {
  StampGuard guard;
  EXPECT_EQ(guard.judge(at(5.0), at(5.0)), Verdict::kGood);
  EXPECT_EQ(guard.judge(at(60.1), at(5.0)), Verdict::kDoubtful);
  EXPECT_EQ(guard.judge(at(60.2), at(60.4)), Verdict::kLeap);
}

}  // namespace
}  // namespace fiimap
