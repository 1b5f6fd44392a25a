#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "effort.h"
#include "fiimap/sliding_grid.h"
#include "oracle.h"

/// The grid against a model made of sets, over random histories.
namespace fiimap {
namespace {

constexpr Plane kAllPlanes[] = {Plane::kKnown, Plane::kOccupied, Plane::kInflated};

/// What the grid should be, as sets of voxels and a map of log-odds of the known ones.
struct GridModel {
  VoxelBox window;
  test::VoxelSet planes[kPlaneCount];
  std::map<VoxelIndex, std::int8_t, test::VoxelLess> log_odds;

  test::VoxelSet& plane(Plane plane) { return planes[static_cast<int>(plane)]; }

  /// \return the occupied voxels left behind.
  test::VoxelSet moveTo(const VoxelIndex& min) {
    window = {min, min + window.size()};
    test::VoxelSet forgotten;
    for (const Plane p : kAllPlanes) {
      for (auto v = plane(p).begin(); v != plane(p).end();) {
        const bool stays = window.contains(*v);
        if (!stays && p == Plane::kOccupied) forgotten.insert(*v);
        if (!stays && p == Plane::kKnown) log_odds.erase(*v);
        v = stays ? std::next(v) : plane(p).erase(v);
      }
    }
    return forgotten;
  }
};

/// Shared tiles with a deep copy of what they held when they were shared.
struct SharedTiles {
  std::vector<std::shared_ptr<const Tile>> tiles;
  std::size_t words;
  std::vector<std::vector<std::uint64_t>> copies;

  explicit SharedTiles(SlidingGrid* grid)
      : tiles(grid->shareTiles()), words(tileWords(grid->layout())) {
    for (const auto& tile : tiles) {
      copies.push_back(contents(tile.get()));
    }
  }
  std::vector<std::uint64_t> contents(const std::uint64_t* tile) const {
    return tile == nullptr ? std::vector<std::uint64_t>()
                           : std::vector<std::uint64_t>(tile, tile + words);
  }
  bool unchanged() const {
    for (std::size_t slot = 0; slot < tiles.size(); ++slot) {
      if (tiles[slot] != nullptr && contents(tiles[slot].get()) != copies[slot]) return false;
    }
    return true;
  }
};

class History {
 public:
  History(const VoxelIndex& size, test::Random* random) : random_(*random), grid_(size) {
    model_.window = grid_.window();
  }

  void step() {
    switch (test::uniformInt(random_, 0, 9)) {
      case 0:
      case 1:
      case 2:
        slide();
        break;
      case 3:
      case 4:
      case 5:
        setBits();
        break;
      case 6:
      case 7:
        writeColumns();
        break;
      case 8:
        shared_.emplace_back(&grid_);
        break;
      default:
        clearSomething();
    }
  }

  void check() {
    ASSERT_NO_FATAL_FAILURE(checkBoxOfVoxels());
    for (const Plane plane : kAllPlanes) {
      test::VoxelField expected(model_.window);
      for (const VoxelIndex& v : model_.plane(plane)) expected.mark(v);
      ASSERT_TRUE(test::planeEquals(grid_, plane, expected)) << "plane " << static_cast<int>(plane);
    }
    for (const auto& [v, value] : model_.log_odds) {
      ASSERT_EQ(grid_.logOdds(v.x(), v.y())[grid_.layout().bitOf(v.z())], value)
          << test::describe(v);
    }
    for (const SharedTiles& shared : shared_) ASSERT_TRUE(shared.unchanged());
  }

 private:
  /// forEach() visits each set voxel of a box once.
  void checkBoxOfVoxels() {
    const VoxelIndex a = test::voxelNearFaces(random_, model_.window);
    const VoxelIndex b = test::voxelNearFaces(random_, model_.window);
    VoxelBox box{a.cwiseMin(b), a.cwiseMax(b) + VoxelIndex::Ones()};
    if (test::chance(random_, 0.3)) box.max.array() += 100;
    const Plane plane = kAllPlanes[test::uniformInt(random_, 0, 2)];
    test::VoxelSet expected, visited;
    for (const VoxelIndex& v : model_.plane(plane)) {
      if (box.contains(v)) expected.insert(v);
    }
    grid_.forEach(plane, box, [&](const VoxelIndex& v) {
      ASSERT_TRUE(visited.insert(v).second) << test::describe(v) << " twice";
    });
    ASSERT_EQ(visited, expected) << test::describe(box);
  }

  void slide() {
    const VoxelBox before = model_.window;
    const VoxelIndex min = before.min + test::randomSlide(random_, before.size());
    ChangeSet changes;
    grid_.moveTo(min, &changes);
    const test::VoxelSet expected = model_.moveTo(min);
    ASSERT_EQ(test::VoxelSet(changes.forgotten.begin(), changes.forgotten.end()), expected);
    ASSERT_EQ(changes.forgotten.size(), expected.size()) << "a voxel was forgotten twice";
    checkEntered(before, changes.entered);
  }

  /// The entered boxes cover what the window did not cover before, and no more.
  void checkEntered(const VoxelBox& before, const std::vector<VoxelBox>& entered) {
    for (const VoxelBox& box : entered) ASSERT_EQ(box.intersection(model_.window), box);
    test::forEachVoxel(model_.window, [&](const VoxelIndex& v) {
      const bool has_entered = std::any_of(entered.begin(), entered.end(),
                                           [&](const VoxelBox& box) { return box.contains(v); });
      ASSERT_EQ(has_entered, !before.contains(v)) << test::describe(v);
    });
  }

  void setBits() {
    const int voxels = test::uniformInt(random_, 1, 60);
    for (int i = 0; i < voxels; ++i) {
      const VoxelIndex v = test::voxelNearFaces(random_, model_.window);
      const Plane plane = kAllPlanes[test::uniformInt(random_, 0, 2)];
      const bool value = test::chance(random_, 0.7);
      grid_.set(plane, v, value);
      if (value) {
        model_.plane(plane).insert(v);
      } else {
        model_.plane(plane).erase(v);
      }
      if (plane == Plane::kKnown) rememberLogOdds(v, value);
    }
  }

  void rememberLogOdds(const VoxelIndex& v, bool known) {
    model_.log_odds.erase(v);
    if (!known) return;
    const auto value = static_cast<std::int8_t>(test::uniformInt(random_, -127, 127));
    grid_.logOdds(v.x(), v.y())[grid_.layout().bitOf(v.z())] = value;
    model_.log_odds[v] = value;
  }

  void writeColumns() {
    const Plane plane = test::chance(random_, 0.5) ? Plane::kOccupied : Plane::kInflated;
    std::vector<std::uint64_t> words(grid_.layout().words());
    for (int i = 0; i < 5; ++i) {
      const VoxelIndex any = test::voxelNearFaces(random_, model_.window);
      std::fill(words.begin(), words.end(), 0);
      const double density = test::uniformReal(random_, 0.0, 1.0);
      for (int z = model_.window.min.z(); z < model_.window.max.z(); ++z) {
        const VoxelIndex v(any.x(), any.y(), z);
        model_.plane(plane).erase(v);
        if (!test::chance(random_, density)) continue;
        model_.plane(plane).insert(v);
        const int bit = grid_.layout().bitOf(z);
        words[bit / kWordBits] |= std::uint64_t{1} << (bit % kWordBits);
      }
      writeColumn(plane, any.x(), any.y(), words);
      const std::uint64_t* stored = grid_.column(plane, any.x(), any.y());
      ASSERT_TRUE(std::equal(words.begin(), words.end(), stored));
    }
  }

  /// In one of the ways that there are.
  void writeColumn(Plane plane, int x, int y, const std::vector<std::uint64_t>& words) {
    const int tile_y = tileFloor(y), column = y - tile_y;
    if (test::chance(random_, 0.3)) return grid_.writeColumn(plane, x, y, words.data());
    if (test::chance(random_, 0.5)) {
      std::vector<Strip> strips(words.size());
      for (std::size_t w = 0; w < words.size(); ++w) strips[w].words[column] = words[w];
      const std::uint32_t columns = std::uint32_t{1} << column;
      return grid_.replaceRows(plane, x, tile_y, 1, &columns, strips.data());
    }
    const std::vector<std::uint64_t> nothing(words.size());
    std::vector<std::uint64_t> row(Strip::kColumns * words.size());
    std::copy(words.begin(), words.end(), row.begin() + column * words.size());
    grid_.writeColumn(plane, x, y, nothing.data());
    grid_.addToColumns(plane, x, tile_y, 1, Strip::kColumns, row.data(), 0);
  }

  void clearSomething() {
    if (test::chance(random_, 0.5)) {
      grid_.clear();
      for (const Plane plane : kAllPlanes) model_.plane(plane).clear();
      model_.log_odds.clear();
      return;
    }
    const Plane plane = test::chance(random_, 0.5) ? Plane::kOccupied : Plane::kInflated;
    grid_.clearPlane(plane);
    model_.plane(plane).clear();
  }

  test::Random& random_;
  SlidingGrid grid_;
  GridModel model_;
  std::vector<SharedTiles> shared_;
};

class SlidingGridModelTest : public ::testing::TestWithParam<VoxelIndex> {};

TEST_P(SlidingGridModelTest, AgreesWithSetsOverRandomHistories) {
  for (int seed = 1; seed <= test::effort(4); ++seed) {
    test::Random random(seed);
    History history(GetParam(), &random);
    for (int step = 0; step < 60; ++step) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
      ASSERT_NO_FATAL_FAILURE(history.step());
      ASSERT_NO_FATAL_FAILURE(history.check());
    }
  }
}

std::string nameOfSize(const ::testing::TestParamInfo<VoxelIndex>& info) {
  return std::to_string(info.param.x()) + "x" + std::to_string(info.param.y()) + "x" +
         std::to_string(info.param.z());
}

INSTANTIATE_TEST_SUITE_P(Sizes, SlidingGridModelTest,
                         ::testing::Values(VoxelIndex(1, 1, 1), VoxelIndex(5, 3, 1),
                                           VoxelIndex(1, 40, 2), VoxelIndex(33, 20, 30),
                                           VoxelIndex(40, 7, 60), VoxelIndex(32, 9, 63),
                                           VoxelIndex(64, 9, 64), VoxelIndex(6, 65, 64),
                                           VoxelIndex(9, 9, 65), VoxelIndex(5, 34, 120),
                                           VoxelIndex(3, 5, 128), VoxelIndex(2, 35, 130)),
                         nameOfSize);

}  // namespace
}  // namespace fiimap
