#include "fiimap/ros/map_changes.h"

#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fiimap/MapInfo.h>
#include <gtest/gtest.h>

#include "../core/effort.h"
#include "../core/inflation_fixture.h"
#include "changes_oracle.h"
#include "fiimap/ros/map_changes_reader.h"

/// What goes through ~changes comes out at the far end, voxel by voxel, or is refused.
namespace fiimap {
namespace {

using test::ElementDefinition;
using Result = MapChangesReader::Result;

constexpr double kMemoryLimit = 100.0;  // MB
constexpr char kFrame[] = "map";

/// A map with random changes, slides, teleports, resets and changes of the inflation.
class History {
 public:
  History(const VoxelIndex& window, test::Random* random)
      : random_(*random), world_(test::kMethods[0], element_, window, random) {}

  std::shared_ptr<const Snapshot> next() {
    constexpr int kFlips = 60;
    for (int several = test::uniformInt(random_, 0, 2); several >= 0; --several) {
      world_.randomStep(kFlips);
    }
    if (test::chance(random_, 0.1)) {
      element_.shape = static_cast<ElementShape>(test::uniformInt(random_, 0, 2));
      element_.radius_mm = test::uniformInt(random_, 0, 450);
      world_.changeElement(element_);
    }
    Snapshot::Info info;
    info.stamp_ns = 1600000000123456789 + static_cast<std::int64_t>(sequence_);
    info.sequence = ++sequence_;
    info.resolution = element_.resolution();
    info.inflation_shape = element_.shape;
    info.inflation_radius = element_.radius();
    return std::make_shared<const Snapshot>(&world_.grid(), info);
  }

  const ElementDefinition& element() const { return element_; }
  test::InflatedWorld& world() { return world_; }

 private:
  test::Random& random_;
  ElementDefinition element_{ElementShape::kBall, 250, 100};
  std::uint64_t sequence_ = 0;
  test::InflatedWorld world_;
};

void expectSame(const Snapshot& found, const Snapshot& expected) {
  ASSERT_EQ(found.window(), expected.window());
  for (const Plane plane : {Plane::kOccupied, Plane::kInflated}) {
    ASSERT_EQ(found.count(plane), expected.count(plane));
    ASSERT_EQ(found.voxels(plane, found.window()), expected.voxels(plane, expected.window()));
  }
  EXPECT_EQ(found.info().stamp_ns, expected.info().stamp_ns);
  EXPECT_EQ(found.info().sequence, expected.info().sequence);
  EXPECT_EQ(found.info().resolution, expected.info().resolution);
  EXPECT_EQ(found.info().inflation_shape, expected.info().inflation_shape);
  EXPECT_EQ(found.info().inflation_radius, expected.info().inflation_radius);
}

/// Neither powers of two nor cubes, and the seams of words and tiles.
const VoxelIndex kWindows[] = {{1, 1, 1},  {1, 70, 3},  {33, 31, 4}, {7, 5, 63},
                               {5, 6, 64}, {4, 40, 66}, {65, 3, 5},  {3, 5, 140}};

class MapChangesHistoryTest : public ::testing::TestWithParam<int> {
 protected:
  /// Calls step(history, random, number) for each of the steps of a history in each window.
  void forEachStep(const std::function<void(History*, test::Random&, int)>& step) const {
    constexpr int kSteps = 40;
    for (const VoxelIndex& window : kWindows) {
      test::Random random(GetParam());
      History history(window, &random);
      for (int i = 0; i < kSteps; ++i) {
        SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", window " + test::describe(window) +
                     ", step " + std::to_string(i));
        step(&history, random, i);
        ASSERT_FALSE(HasFatalFailure());
      }
    }
  }
};

TEST_P(MapChangesHistoryTest, ReaderHasTheMapAfterEveryMessage) {
  std::shared_ptr<const Snapshot> before;
  MapChangesReader reader(kMemoryLimit);
  forEachStep([&](History* history, test::Random& random, int step) {
    const std::shared_ptr<const Snapshot> now = history->next();
    const bool is_keyframe = step == 0 || test::chance(random, 0.1);
    const MapChanges message = toMapChanges(*now, is_keyframe ? nullptr : before.get(), kFrame);
    ASSERT_EQ(reader.read(message), Result::kMap);
    ASSERT_NE(reader.snapshot(), nullptr);
    expectSame(*reader.snapshot(), *now);
    before = now;
  });
}

TEST_P(MapChangesHistoryTest, MessagesMeanWhatTheirDefinitionSays) {
  std::shared_ptr<const Snapshot> before;
  test::ChangesOracle oracle;
  forEachStep([&](History* history, test::Random& random, int step) {
    const std::shared_ptr<const Snapshot> now = history->next();
    const bool is_keyframe = step == 0 || test::chance(random, 0.1);
    oracle.apply(toMapChanges(*now, is_keyframe ? nullptr : before.get(), kFrame));
    ASSERT_EQ(oracle.window(), history->world().grid().window());
    ASSERT_EQ(oracle.occupied(), history->world().occupied());
    const test::VoxelField inflated = oracle.inflated(history->element());
    ASSERT_TRUE(test::planeEquals(history->world().grid(), Plane::kInflated, inflated));
    before = now;
  });
}

TEST_P(MapChangesHistoryTest, LossIsNoticedAndTheNextKeyframeHelps) {
  std::shared_ptr<const Snapshot> before;
  MapChangesReader reader(kMemoryLimit);
  bool is_in_step = false;
  int lost = 0;
  forEachStep([&](History* history, test::Random& random, int step) {
    const std::shared_ptr<const Snapshot> now = history->next();
    const bool is_keyframe = step == 0 || test::chance(random, 0.15);
    const MapChanges message = toMapChanges(*now, is_keyframe ? nullptr : before.get(), kFrame);
    before = now;
    if (step > 0 && test::chance(random, 0.1)) {
      ++lost;
      is_in_step = false;
      return;
    }
    const bool had_a_map = reader.snapshot() != nullptr;
    const Result result = reader.read(message);
    is_in_step = is_in_step || is_keyframe;
    if (is_in_step) {
      ASSERT_EQ(result, Result::kMap);
      expectSame(*reader.snapshot(), *now);
    } else {
      ASSERT_EQ(result, had_a_map ? Result::kLost : Result::kWaiting);
      ASSERT_EQ(reader.snapshot(), nullptr);
    }
  });
  EXPECT_GT(lost, 0);
}

TEST_P(MapChangesHistoryTest, DamagedChangesAreRefusedOrMakeAMapOfTheSameSize) {
  std::shared_ptr<const Snapshot> before;
  forEachStep([&](History* history, test::Random& random, int step) {
    const std::shared_ptr<const Snapshot> now = history->next();
    if (step == 0) before = nullptr;
    MapChangesReader reader(kMemoryLimit);
    if (before) reader.read(toMapChanges(*before, nullptr, kFrame));
    MapChanges message = toMapChanges(*now, before.get(), kFrame);
    before = now;
    const int at = test::uniformInt(random, 0, static_cast<int>(message.changes.size()));
    if (at == static_cast<int>(message.changes.size()) || test::chance(random, 0.2)) {
      message.changes.resize(test::uniformInt(random, 0, at + 3), 0x91);
    } else {
      message.changes[at] ^= 1 << test::uniformInt(random, 0, 7);
    }
    try {
      ASSERT_EQ(reader.read(message), Result::kMap);
      ASSERT_EQ(reader.snapshot()->count(Plane::kOccupied), now->count(Plane::kOccupied));
      ASSERT_EQ(reader.snapshot()->count(Plane::kInflated), now->count(Plane::kInflated));
    } catch (const std::invalid_argument&) {
      ASSERT_EQ(reader.snapshot(), nullptr);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Seeds, MapChangesHistoryTest, ::testing::Range(1, 1 + test::effort(10)));

/// A map of 20 x 10 x 6 voxels of 0.5 m with a few obstacles, and the message of a change.
class MapChangesTest : public ::testing::Test {
 protected:
  MapChangesTest() : grid_({20, 10, 6}) {
    ChangeSet changes;
    grid_.moveTo({-10, -5, -3}, &changes);
    for (const int x : {-10, 0, 3}) grid_.set(Plane::kOccupied, {x, 1, 2}, true);
    first_ = snapshot(1);
    grid_.set(Plane::kOccupied, {0, 1, 2}, false);
    grid_.set(Plane::kOccupied, {0, 1, 1}, true);
    second_ = snapshot(2);
    keyframe_ = toMapChanges(*first_, nullptr, kFrame);
    change_ = toMapChanges(*second_, first_.get(), kFrame);
  }

  /// With a radius of 0: what is inflated is occupied.
  std::shared_ptr<const Snapshot> snapshot(std::uint64_t sequence) {
    std::vector<VoxelIndex> occupied;
    grid_.forEach(Plane::kOccupied, grid_.window(),
                  [&](const VoxelIndex& v) { occupied.push_back(v); });
    grid_.clearPlane(Plane::kInflated);
    for (const VoxelIndex& v : occupied) grid_.set(Plane::kInflated, v, true);
    Snapshot::Info info;
    info.stamp_ns = 1600000000000000000;
    info.sequence = sequence;
    info.resolution = 0.5;
    return std::make_shared<const Snapshot>(&grid_, info);
  }

  /// Expects that both a keyframe and a change are refused when they are spoiled, with a text that
  /// contains `words`, and that the reader goes on with the next keyframe.
  void expectRefused(const std::string& words, const std::function<void(MapChanges*)>& spoil) {
    for (const bool is_keyframe : {true, false}) {
      MapChangesReader reader(kMemoryLimit);
      ASSERT_EQ(reader.read(keyframe_), Result::kMap);
      MapChanges message = is_keyframe ? keyframe_ : change_;
      spoil(&message);
      try {
        reader.read(message);
        ADD_FAILURE() << words << " is not refused";
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      }
      EXPECT_EQ(reader.snapshot(), nullptr);
      EXPECT_EQ(reader.read(change_), Result::kWaiting);
      EXPECT_EQ(reader.read(keyframe_), Result::kMap);
      EXPECT_EQ(reader.read(change_), Result::kMap);
      expectSame(*reader.snapshot(), *second_);
    }
  }

  SlidingGrid grid_;
  std::shared_ptr<const Snapshot> first_, second_;
  MapChanges keyframe_, change_;
};

TEST_F(MapChangesTest, AMessageTellsWhatTheSnapshotTells) {
  EXPECT_EQ(change_.header.frame_id, kFrame);
  EXPECT_EQ(change_.header.stamp.toNSec(), 1600000000000000000u);
  EXPECT_EQ(change_.sequence, 2u);
  EXPECT_EQ(change_.previous, 1u);
  EXPECT_EQ(change_.resolution, 0.5);
  EXPECT_EQ(change_.window_min[0], -10);
  EXPECT_EQ(change_.window_max[2], 3);
  EXPECT_EQ(change_.occupied, 3u);
  EXPECT_EQ(change_.inflated, 3u);
  // From (-10, -5, -3) to (0, 1, 1) the row has 10 * 10 * 6 + 6 * 6 + 4 voxels; then two change.
  const std::vector<std::uint8_t> numbers{0x80 | (640 & 0x7f), 640 >> 7, 2};
  EXPECT_EQ(test::bytesOfZlib(change_.changes), numbers);
  EXPECT_EQ(keyframe_.previous, 0u);
}

TEST_F(MapChangesTest, NothingNewTakesNoByte) {
  EXPECT_TRUE(toMapChanges(*snapshot(3), second_.get(), kFrame).changes.empty());
}

TEST_F(MapChangesTest, AnEmptyKeyframeSaysThatThereIsNoMap) {
  MapChangesReader reader(kMemoryLimit);
  const MapChanges empty = toEmptyKeyframe(keyframe_.header);
  EXPECT_EQ(reader.read(empty), Result::kNoMap);
  EXPECT_EQ(reader.read(keyframe_), Result::kMap);
  EXPECT_EQ(reader.read(empty), Result::kNoMap);
  EXPECT_EQ(reader.snapshot(), nullptr);
  EXPECT_EQ(reader.read(change_), Result::kWaiting);
}

TEST_F(MapChangesTest, ASnapshotOfTheReaderStaysAsItIs) {
  MapChangesReader reader(kMemoryLimit);
  reader.read(keyframe_);
  const std::shared_ptr<const Snapshot> kept = reader.snapshot();
  reader.read(change_);
  reader.read(toEmptyKeyframe(keyframe_.header));
  expectSame(*kept, *first_);
}

TEST_F(MapChangesTest, AMessageTwiceIsNotAppliedTwice) {
  MapChangesReader reader(kMemoryLimit);
  reader.read(keyframe_);
  reader.read(change_);
  EXPECT_EQ(reader.read(change_), Result::kLost);
  EXPECT_EQ(reader.snapshot(), nullptr);
}

TEST_F(MapChangesTest, RefusesWindowsThatCannotBe) {
  expectRefused("window_min[1]", [](MapChanges* m) { m->window_max[1] = m->window_min[1]; });
  expectRefused("window_min[0]", [](MapChanges* m) {
    m->window_min[0] = std::numeric_limits<std::int32_t>::min();
    m->window_max[0] = std::numeric_limits<std::int32_t>::max();
  });
  expectRefused("window_min[2]", [](MapChanges* m) { m->window_max[2] = -2147483647 - 1; });
}

TEST_F(MapChangesTest, RefusesMapsThatCannotBe) {
  for (const double number : {0.0, -1.0, 1e-300, 1e300, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    expectRefused("resolution", [=](MapChanges* m) { m->resolution = number; });
  }
  for (const double number : {-1.0, 33.0, 1e300, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    expectRefused("inflation_radius", [=](MapChanges* m) { m->inflation_radius = number; });
  }
  expectRefused("inflation_shape", [](MapChanges* m) { m->inflation_shape = 3; });
}

TEST_F(MapChangesTest, RefusesMapsBeyondTheMemoryLimit) {
  MapChanges message = keyframe_;
  message.window_max[0] = message.window_min[0] + 19000;
  message.window_max[1] = message.window_min[1] + 19000;
  MapChangesReader reader(kMemoryLimit);
  try {
    reader.read(message);
    ADD_FAILURE() << "a map of 19000 x 19000 x 6 voxels is not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("memory_limit"), std::string::npos) << error.what();
  }
}

TEST_F(MapChangesTest, RefusesAChangeOfTheGridWithoutAKeyframe) {
  MapChangesReader reader(kMemoryLimit);
  reader.read(keyframe_);
  change_.window_max[0] += 1;
  EXPECT_THROW(reader.read(change_), std::invalid_argument);
}

TEST_F(MapChangesTest, RefusesSequencesThatCannotBe) {
  MapChangesReader reader(kMemoryLimit);
  reader.read(keyframe_);
  change_.sequence = 1;
  EXPECT_THROW(reader.read(change_), std::invalid_argument);
  change_.sequence = 0;
  EXPECT_THROW(reader.read(change_), std::invalid_argument);
  MapChanges empty = toEmptyKeyframe(keyframe_.header);
  empty.changes = test::zlibStream({0, 1});
  EXPECT_THROW(reader.read(empty), std::invalid_argument);
}

TEST_F(MapChangesTest, RefusesChangesThatAreNone) {
  const auto with = [this](const std::vector<std::uint8_t>& bytes) {
    expectRefused("changes: ", [&](MapChanges* m) { m->changes = test::zlibStream(bytes); });
  };
  with({5});                    // a number too few
  with({5, 0x80});              // a number that does not end
  with({5, 0});                 // nothing that changes
  with({5, 1, 0, 1});           // two runs that are one
  with({5, 0xff, 0xff, 0x7f});  // beyond the window
  with({0xff, 0xff, 0x7f, 1});
  with({0, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x02});  // 2^64
  with({0, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01});  // 2^64 - 1
}

TEST_F(MapChangesTest, RefusesChangesThatAreNoZlibStream) {
  expectRefused("no zlib stream", [](MapChanges* m) { m->changes = {5, 1}; });
  expectRefused("no zlib stream", [](MapChanges* m) { m->changes.back() ^= 1; });
  expectRefused("without its end", [](MapChanges* m) { m->changes.pop_back(); });
  expectRefused("1 bytes after", [](MapChanges* m) { m->changes.push_back(0); });
}

TEST_F(MapChangesTest, RefusesAMillionNumbersInFewBytes) {
  const std::vector<std::uint8_t> zeros(1 << 20, 0);
  expectRefused("changes: 0 voxels", [&](MapChanges* m) { m->changes = test::zlibStream(zeros); });
}

TEST_F(MapChangesTest, RefusesWhatDoesNotAddUp) {
  expectRefused("occupied = 4", [](MapChanges* m) { m->occupied = 4; });
  expectRefused("inflated = 2", [](MapChanges* m) { m->inflated = 2; });
}

}  // namespace
}  // namespace fiimap
