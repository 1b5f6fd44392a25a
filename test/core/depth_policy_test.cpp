#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "fiimap/depth_projector.h"
#include "special_numbers.h"

/// What readings without a usable distance say: each kind has its own policy.
namespace fiimap {
namespace {

constexpr double kPolicyTolerance = 1e-4;  // m

/// One pixel, 45 degrees off the optical axis, so that depth and ray length differ by sqrt(2).
constexpr PinholeIntrinsics kPolicyCamera{100.0, 100.0, -100.0, 0.0};

enum class Kind { kReturn, kInvalid, kTooNear, kInfinite, kTooFar };

struct Reading {
  ReadingCount count;
  RangeData scan;

  Kind kind() const {
    if (count.returns == 1) return Kind::kReturn;
    if (count.invalid == 1) return Kind::kInvalid;
    if (count.too_near == 1) return Kind::kTooNear;
    return count.infinite == 1 ? Kind::kInfinite : Kind::kTooFar;
  }
};

Reading checked(Reading reading) {
  const ReadingCount& c = reading.count;
  EXPECT_EQ(c.total, 1u);
  EXPECT_EQ(c.returns + c.invalid + c.too_near + c.infinite + c.too_far, 1u) << "is of one kind";
  EXPECT_EQ(reading.scan.returns.size(), c.returns);
  EXPECT_LE(reading.scan.returns.size() + reading.scan.misses.size(), 1u);
  return reading;
}

Reading read(const MapperConfig& config, float metres) {
  const DepthImage image{&metres, DepthImage::Format::kFloat32, 1, 1, sizeof(metres)};
  Reading reading;
  reading.count = DepthProjector(config).project(image, kPolicyCamera,
                                                 Eigen::Isometry3d::Identity(), &reading.scan);
  return checked(reading);
}

Reading readUnits(const MapperConfig& config, std::uint16_t units) {
  const DepthImage image{&units, DepthImage::Format::kUint16, 1, 1, sizeof(units)};
  Reading reading;
  reading.count = DepthProjector(config).project(image, kPolicyCamera,
                                                 Eigen::Isometry3d::Identity(), &reading.scan);
  return checked(reading);
}

MapperConfig policies(ReadingPolicy invalid, ReadingPolicy infinite, ReadingPolicy beyond) {
  MapperConfig config;
  config.pixel_step = 1;
  config.border_margin = 0;
  config.min_depth = 0.5;
  config.max_depth = 5.0;
  config.min_ray_length = 0.0;
  config.max_ray_length = 100.0;
  config.invalid_depth = invalid;
  config.infinite_depth = infinite;
  config.beyond_max_depth = beyond;
  return config;
}

MapperConfig allPolicies(ReadingPolicy policy) { return policies(policy, policy, policy); }

constexpr ReadingPolicy kIgnore = ReadingPolicy::kIgnore;
constexpr ReadingPolicy kFree = ReadingPolicy::kFree;

/// The ray is free up to this depth.
void expectMiss(const Reading& reading, double depth) {
  ASSERT_EQ(reading.scan.misses.size(), 1u);
  EXPECT_NEAR(reading.scan.misses[0].x(), depth, kPolicyTolerance);
  EXPECT_NEAR(reading.scan.misses[0].y(), 0.0, kPolicyTolerance);
  EXPECT_NEAR(reading.scan.misses[0].z(), depth, kPolicyTolerance);
}

TEST(DepthPolicyTest, KindsOfFloatReadings) {
  const MapperConfig config = allPolicies(kIgnore);
  for (const float invalid : {0.0f, -0.0f, -1.0f, -100.0f, -kInf, kNan, -kNan}) {
    EXPECT_EQ(read(config, invalid).kind(), Kind::kInvalid) << invalid;
  }
  EXPECT_EQ(read(config, kInf).kind(), Kind::kInfinite);
  EXPECT_EQ(read(config, 1e-30f).kind(), Kind::kTooNear);
  EXPECT_EQ(read(config, 0.49f).kind(), Kind::kTooNear);
  EXPECT_EQ(read(config, 0.51f).kind(), Kind::kReturn);
  EXPECT_EQ(read(config, 4.99f).kind(), Kind::kReturn);
  EXPECT_EQ(read(config, 5.01f).kind(), Kind::kTooFar);
  EXPECT_EQ(read(config, 65.535f).kind(), Kind::kTooFar) << "is an ordinary number of metres";
  EXPECT_EQ(read(config, std::numeric_limits<float>::max()).kind(), Kind::kTooFar);
}

TEST(DepthPolicyTest, KindsOf16BitReadings) {
  const MapperConfig config = allPolicies(kIgnore);
  EXPECT_EQ(readUnits(config, 0).kind(), Kind::kInvalid);
  EXPECT_EQ(readUnits(config, 65535).kind(), Kind::kInvalid);
  EXPECT_EQ(readUnits(config, 1).kind(), Kind::kTooNear);
  EXPECT_EQ(readUnits(config, 499).kind(), Kind::kTooNear);
  EXPECT_EQ(readUnits(config, 501).kind(), Kind::kReturn);
  EXPECT_EQ(readUnits(config, 4999).kind(), Kind::kReturn);
  EXPECT_EQ(readUnits(config, 5001).kind(), Kind::kTooFar);
  EXPECT_EQ(readUnits(config, 65534).kind(), Kind::kTooFar);
}

TEST(DepthPolicyTest, TheLimitsThemselvesAreInRange) {
  const MapperConfig config = allPolicies(kIgnore);
  EXPECT_EQ(read(config, 0.5f).kind(), Kind::kReturn);
  EXPECT_EQ(read(config, 5.0f).kind(), Kind::kReturn);
}

TEST(DepthPolicyTest, IgnoredReadingsMakeNoRay) {
  const MapperConfig config = allPolicies(kIgnore);
  for (const float depth : {0.0f, kNan, kInf, 100.0f, 0.1f, -kInf}) {
    EXPECT_TRUE(read(config, depth).scan.misses.empty()) << depth;
  }
  for (const int units : {0, 65535, 65534, 100}) {
    EXPECT_TRUE(readUnits(config, static_cast<std::uint16_t>(units)).scan.misses.empty()) << units;
  }
}

TEST(DepthPolicyTest, EachPolicyIsForItsKindOnly) {
  struct Case {
    MapperConfig config;
    bool invalid_frees, infinite_frees, beyond_frees;
  };
  for (const Case& c : {Case{policies(kFree, kIgnore, kIgnore), true, false, false},
                        Case{policies(kIgnore, kFree, kIgnore), false, true, false},
                        Case{policies(kIgnore, kIgnore, kFree), false, false, true}}) {
    for (const float depth : {0.0f, kNan, -1.0f, -kInf}) {
      EXPECT_EQ(!read(c.config, depth).scan.misses.empty(), c.invalid_frees) << depth;
    }
    for (const int units : {0, 65535}) {
      const Reading reading = readUnits(c.config, static_cast<std::uint16_t>(units));
      EXPECT_EQ(!reading.scan.misses.empty(), c.invalid_frees) << units;
    }
    EXPECT_EQ(!read(c.config, kInf).scan.misses.empty(), c.infinite_frees);
    EXPECT_EQ(!read(c.config, 6.0f).scan.misses.empty(), c.beyond_frees);
    EXPECT_TRUE(read(c.config, 0.1f).scan.misses.empty()) << "too near is never free";
  }
}

TEST(DepthPolicyTest, FreeMeansFreeUpToTheMaximumDepth) {
  const MapperConfig config = allPolicies(kFree);
  for (const float depth : {0.0f, kNan, kInf, 6.0f, std::numeric_limits<float>::max()}) {
    SCOPED_TRACE(depth);
    expectMiss(read(config, depth), 5.0);
  }
  expectMiss(readUnits(config, 65535), 5.0);
}

TEST(DepthPolicyTest, FreeEndsAtTheMaximumRayLengthWhereThatIsShorter) {
  MapperConfig config = allPolicies(kFree);
  config.max_ray_length = 3.0;
  for (const float depth : {0.0f, kInf, 6.0f, 2.5f}) {
    SCOPED_TRACE(depth);
    expectMiss(read(config, depth), 3.0 / std::sqrt(2.0));
  }
}

TEST(DepthPolicyTest, FreeStopsShortOfASurfaceBeyondTheMaximum) {
  MapperConfig config = allPolicies(kFree);
  config.resolution = 0.2;
  config.ray_end_cut = 1.5;  // 0.3 m along the ray
  expectMiss(read(config, 5.1f), 5.1 - 0.3 / std::sqrt(2.0));
  expectMiss(readUnits(config, 5100), 5.1 - 0.3 / std::sqrt(2.0));
  expectMiss(read(config, 5.3f), 5.0);
  config.max_ray_length = 3.0;
  expectMiss(read(config, 2.2f), 2.2 - 0.3 / std::sqrt(2.0));
  config.ray_end_cut = 40.0;
  EXPECT_TRUE(read(config, 5.1f).scan.misses.empty());
}

TEST(DepthPolicyTest, RayLengthIsMeasuredAlongTheRay) {
  MapperConfig config = allPolicies(kIgnore);
  config.min_ray_length = 1.0;
  config.max_ray_length = 3.0;
  // Depth 0.70 is 0.99 m along the ray, 0.72 is 1.02 m; 2.11 is 2.98 m, 2.13 is 3.01 m.
  EXPECT_EQ(read(config, 0.70f).kind(), Kind::kTooNear);
  EXPECT_EQ(read(config, 0.72f).kind(), Kind::kReturn);
  EXPECT_EQ(read(config, 2.11f).kind(), Kind::kReturn);
  EXPECT_EQ(read(config, 2.13f).kind(), Kind::kTooFar);
}

}  // namespace
}  // namespace fiimap
