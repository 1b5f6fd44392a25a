#include "fiimap/ros/transform_tree.h"

#include <limits>

#include <gtest/gtest.h>

#include "messages.h"

namespace fiimap {
namespace {

constexpr double kTreeHistory = 5.0;
constexpr double kTreeMaxGap = 0.1;
constexpr double kTreeTolerance = 1e-6;

class TransformTreeTest : public testing::Test {
 protected:
  void addMoving(double seconds, double x, const std::string& parent = "world",
                 const std::string& child = "body") {
    tree_.add(transformAt(seconds, x, 0.0, parent, child), false);
  }
  void addStatic(double x, const std::string& parent = "body",
                 const std::string& child = "camera") {
    tree_.add(transformAt(0.0, x, 0.0, parent, child), true);
  }
  TransformAtStamp lookup(double seconds, const std::string& target = "world",
                          const std::string& source = "camera") const {
    return tree_.at(target, source, at(seconds), kTreeMaxGap);
  }

  TransformTree tree_{kTreeHistory};
};

TEST_F(TransformTreeTest, AnyFrameIsAtItself) {
  EXPECT_EQ(lookup(0.0, "nowhere", "nowhere").lookup, PoseLookup::kFound);
}

TEST_F(TransformTreeTest, ChainsStaticAndMovingLinks) {
  addStatic(0.5);
  addMoving(0.0, 1.0);
  addMoving(0.05, 2.0);
  const TransformAtStamp found = lookup(0.02);
  ASSERT_EQ(found.lookup, PoseLookup::kFound) << found.why;
  EXPECT_NEAR(found.T_target_source.translation().x(), 1.9, kTreeTolerance);
  EXPECT_NEAR(found.gap, 0.05, kTreeTolerance);
}

TEST_F(TransformTreeTest, TellsWaitingFromTooLate) {
  addStatic(0.5);
  EXPECT_EQ(lookup(0.0).lookup, PoseLookup::kNotYet);
  EXPECT_FALSE(lookup(0.0).why.empty());
  addMoving(1.0, 1.0);
  addMoving(1.05, 1.0);
  EXPECT_EQ(lookup(1.06).lookup, PoseLookup::kNotYet);
  EXPECT_EQ(lookup(0.99).lookup, PoseLookup::kTooOld);
}

TEST_F(TransformTreeTest, RefusesToInterpolateOverAGap) {
  addStatic(0.5);
  addMoving(0.0, 1.0);
  addMoving(0.2, 2.0);
  const TransformAtStamp found = lookup(0.1);
  EXPECT_EQ(found.lookup, PoseLookup::kGap);
  EXPECT_NEAR(found.gap, 0.2, kTreeTolerance);
}

TEST_F(TransformTreeTest, AFixedLinkThatIsRepeatedSeldomIsNoGap) {
  addMoving(0.0, 0.5, "body", "camera");
  addMoving(1.0, 0.5, "body", "camera");
  for (int i = 0; i <= 20; ++i) addMoving(0.05 * i, i);
  EXPECT_EQ(lookup(0.52).lookup, PoseLookup::kFound) << lookup(0.52).why;
}

TEST_F(TransformTreeTest, TheLinkAboveTheChainDoesNotMatter) {
  addMoving(0.0, 0.0, "earth", "world");
  addMoving(4.0, 1.0, "earth", "world");
  addStatic(0.5);
  for (int i = 0; i <= 40; ++i) addMoving(0.05 * i, i);
  EXPECT_EQ(lookup(1.02).lookup, PoseLookup::kFound) << lookup(1.02).why;
}

TEST_F(TransformTreeTest, TakesFrameIdsWithASlash) {
  addStatic(0.5, "/body", "/camera");
  addMoving(0.0, 1.0, "/world", "/body");
  EXPECT_EQ(lookup(0.0).lookup, PoseLookup::kFound);
}

TEST_F(TransformTreeTest, LeavesOutBadTransforms) {
  addStatic(0.5);
  addMoving(0.0, 1.0);
  addMoving(0.02, std::numeric_limits<double>::quiet_NaN());
  addMoving(0.03, 1.0, "", "body");
  addMoving(0.03, 1.0, "world", "");
  addMoving(0.03, 1.0, "body", "body");
  addMoving(0.04, 5.0);
  EXPECT_NEAR(lookup(0.02).T_target_source.translation().x(), 3.5, kTreeTolerance);
}

TEST_F(TransformTreeTest, CountsWhatItLeavesOutButNotRepetitions) {
  addMoving(0.0, 1.0);
  addMoving(0.0, 1.0);
  EXPECT_EQ(tree_.refused(), 0u);
  addMoving(0.01, std::numeric_limits<double>::quiet_NaN());
  addMoving(0.01, 1.0, "", "body");
  EXPECT_EQ(tree_.refused(), 2u);
}

TEST_F(TransformTreeTest, OneWrongStampCostsOneTransform) {
  addStatic(0.5);
  for (const double wrong : {100.0, -100.0}) {
    tree_.clear();
    for (int i = 0; i <= 10; ++i) {
      addMoving(0.05 * i, 0.05 * i);
      if (i == 5) addMoving(wrong, 7.0);
    }
    ASSERT_EQ(lookup(0.47).lookup, PoseLookup::kFound) << lookup(0.47).why;
    EXPECT_NEAR(lookup(0.47).T_target_source.translation().x(), 0.97, kTreeTolerance);
    EXPECT_NEAR(lookup(0.27).T_target_source.translation().x(), 0.77, kTreeTolerance);
  }
  EXPECT_EQ(tree_.refused(), 2u);
}

TEST_F(TransformTreeTest, ALinkWhoseFirstStampWasWrongRecovers) {
  addStatic(0.5);
  addMoving(100.0, 7.0);
  for (int i = 0; i <= 3; ++i) addMoving(0.05 * i, 1.0);
  EXPECT_EQ(lookup(0.12).lookup, PoseLookup::kFound) << lookup(0.12).why;
}

TEST_F(TransformTreeTest, TimeMayGoOnAfterAPause) {
  addStatic(0.5);
  addMoving(0.0, 1.0);
  addMoving(60.0, 1.0);
  EXPECT_EQ(lookup(60.0).lookup, PoseLookup::kNotYet);
  addMoving(60.05, 1.0);
  EXPECT_EQ(lookup(60.02).lookup, PoseLookup::kFound) << lookup(60.02).why;
  EXPECT_EQ(tree_.refused(), 0u);
}

TEST_F(TransformTreeTest, StampsNearThoseOfOtherMessagesAreNotAhead) {
  addStatic(0.5);
  addMoving(0.0, 1.0);
  tree_.add(transformAt(2.0, 1.0), false, at(2.1));
  EXPECT_EQ(lookup(2.0).lookup, PoseLookup::kFound) << lookup(2.0).why;
}

TEST_F(TransformTreeTest, ASecondPublisherThatIsLateIsNoNewTime) {
  addStatic(0.5);
  for (int i = 0; i <= 20; ++i) addMoving(4.0 + 0.05 * i, 1.0);
  for (int i = 0; i <= 5; ++i) addMoving(2.0 + 0.05 * i, 1.0);
  EXPECT_EQ(lookup(4.42).lookup, PoseLookup::kFound) << lookup(4.42).why;
}

TEST_F(TransformTreeTest, ClearKeepsStaticLinks) {
  addStatic(0.5);
  addMoving(100.0, 1.0);
  tree_.clear();
  EXPECT_EQ(lookup(100.0).lookup, PoseLookup::kNotYet);
  addMoving(0.0, 2.0);
  ASSERT_EQ(lookup(0.0).lookup, PoseLookup::kFound) << lookup(0.0).why;
  EXPECT_NEAR(lookup(0.0).T_target_source.translation().x(), 2.5, kTreeTolerance);
}

}  // namespace
}  // namespace fiimap
