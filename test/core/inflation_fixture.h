#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fiimap/inflater.h"
#include "oracle.h"

namespace fiimap::test {

/// A method of inflation; the connectivity counts for bfs only.
struct Method {
  InflationMethod method;
  int connectivity;
};

constexpr Method kMethods[] = {{InflationMethod::kIncremental, 6},
                               {InflationMethod::kBfs, 6},
                               {InflationMethod::kBfs, 18},
                               {InflationMethod::kBfs, 26},
                               {InflationMethod::kBatch, 6}};

inline std::string nameOf(const Method& method) {
  switch (method.method) {
    case InflationMethod::kIncremental:
      return "incremental";
    case InflationMethod::kBfs:
      return "bfs" + std::to_string(method.connectivity);
    case InflationMethod::kBatch:
      return "batch";
  }
  return "";
}

inline std::string nameOfMethod(const ::testing::TestParamInfo<Method>& info) {
  return nameOf(info.param);
}

inline void PrintTo(const Method& method, std::ostream* out) { *out << nameOf(method); }

/// Configuration of a map of this size in voxels and with this inflation.
inline MapperConfig configFor(const Method& method, const ElementDefinition& element,
                              const VoxelIndex& size) {
  MapperConfig config;
  config.resolution = element.resolution();
  config.map_size_x = size.x() * config.resolution;
  config.map_size_y = size.y() * config.resolution;
  config.map_size_z = size.z() * config.resolution;
  config.inflation_radius = element.radius();
  config.inflation_shape = element.shape;
  config.inflation_method = method.method;
  config.bfs_connectivity = method.connectivity;
  return config;
}

/// A grid with an inflater under test, and the set of its occupied voxels.
class InflatedWorld {
 public:
  InflatedWorld(const Method& method, const ElementDefinition& element, const VoxelIndex& size,
                Random* random)
      : method_(method), random_(*random), grid_(size) {
    changeElement(element);
  }

  SlidingGrid& grid() { return grid_; }
  const VoxelSet& occupied() const { return occupied_; }

  /// A new inflater with another element, which computes the plane anew.
  void changeElement(const ElementDefinition& element) {
    element_ = element;
    offsets_ = element.offsets();
    inflater_ = makeInflater(configFor(method_, element, grid_.window().size()));
    rebuild();
  }
  void rebuild() { rebuildInflation(inflater_.get(), &grid_); }

  /// One scan's worth: the window moves, then voxels become occupied or free, then inflation.
  void update(const VoxelIndex& slide, const VoxelSet& flips) {
    ChangeSet changes;
    grid_.moveTo(grid_.window().min + slide, &changes);
    for (const VoxelIndex& v : changes.forgotten) occupied_.erase(v);
    for (const VoxelIndex& v : flips) {
      const bool becomes_occupied = occupied_.count(v) == 0;
      (becomes_occupied ? changes.lower : changes.raise).push_back(v);
      if (becomes_occupied) {
        occupied_.insert(v);
      } else {
        occupied_.erase(v);
      }
      grid_.set(Plane::kKnown, v, true);
      grid_.set(Plane::kOccupied, v, becomes_occupied);
    }
    std::shuffle(changes.lower.begin(), changes.lower.end(), random_);
    std::shuffle(changes.raise.begin(), changes.raise.end(), random_);
    inflater_->update(changes, &grid_);
  }

  void reset() {
    grid_.clear();
    occupied_.clear();
  }

  /// Some flips, alone or with a slide; now and then a reset or a snapshot before them.
  void randomStep(int most_flips) {
    constexpr double kRare = 0.08;
    if (chance(random_, kRare)) reset();
    if (chance(random_, kRare)) shared_ = grid_.shareTiles();
    const VoxelIndex slide = chance(random_, 0.5) ? VoxelIndex::Zero().eval()
                                                  : randomSlide(random_, grid_.window().size());
    const VoxelBox next{grid_.window().min + slide, grid_.window().max + slide};
    update(slide, randomFlips(next, most_flips));
  }

  ::testing::AssertionResult inflationIsExact() const {
    return planeEquals(grid_, Plane::kInflated, dilate(occupied_, offsets_, grid_.window()));
  }

 private:
  /// New obstacles and, as often, occupied voxels that become free.
  VoxelSet randomFlips(const VoxelBox& window, int most) {
    constexpr int kFew = 3;
    const int room = static_cast<int>(1 + window.volume() / 20);
    const int many = std::min(most, room);
    const int count = uniformInt(random_, 0, chance(random_, 0.7) ? std::min(kFew, many) : many);
    VoxelSet flips;
    for (int i = 0; i < count; ++i) flips.insert(voxelNearFaces(random_, window));
    const bool all = chance(random_, 0.1);
    const double share = all ? 1.0 : count / (1.0 + occupied_.size());
    for (const VoxelIndex& v : occupied_) {
      if (window.contains(v) && chance(random_, share)) flips.insert(v);
    }
    return flips;
  }

  Method method_;
  Random& random_;
  SlidingGrid grid_;
  ElementDefinition element_;
  std::vector<VoxelIndex> offsets_;
  std::unique_ptr<Inflater> inflater_;
  VoxelSet occupied_;
  std::vector<std::shared_ptr<const Tile>> shared_;
};

}  // namespace fiimap::test
