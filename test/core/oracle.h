#pragma once

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fiimap/range_data.h"
#include "fiimap/sliding_grid.h"
#include "fiimap/structuring_element.h"
#include "fiimap/voxel_lattice.h"

/// Reference models written from the definitions alone, slow and simple, and seeded random worlds.
namespace fiimap::test {

inline std::vector<Eigen::Vector3f> toVector(const PointList& points) {
  std::vector<Eigen::Vector3f> vector;
  for (const Eigen::Vector3f& point : points) vector.push_back(point);
  return vector;
}

using Random = std::mt19937;

/// \param low, high both included.
inline int uniformInt(Random& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}

inline double uniformReal(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline bool chance(Random& random, double probability) {
  return uniformReal(random, 0.0, 1.0) < probability;
}

inline VoxelIndex uniformVoxel(Random& random, const VoxelBox& box) {
  return {uniformInt(random, box.min.x(), box.max.x() - 1),
          uniformInt(random, box.min.y(), box.max.y() - 1),
          uniformInt(random, box.min.z(), box.max.z() - 1)};
}

/// A voxel of the box that lies at one or more of its faces more often than not.
inline VoxelIndex voxelNearFaces(Random& random, const VoxelBox& box) {
  constexpr double kAtFace = 0.2;
  VoxelIndex v = uniformVoxel(random, box);
  for (int axis = 0; axis < 3; ++axis) {
    if (chance(random, kAtFace)) v[axis] = box.min[axis];
    if (chance(random, kAtFace)) v[axis] = box.max[axis] - 1;
  }
  return v;
}

/// A step of a window: none, by one voxel, shorter or longer than the window, or a teleport.
inline VoxelIndex randomSlide(Random& random, const VoxelIndex& size) {
  constexpr int kFar = 1000000;
  VoxelIndex step = VoxelIndex::Zero();
  const int kind = uniformInt(random, 0, 4);
  for (int axis = 0; axis < 3; ++axis) {
    const int reach = kind == 1 ? 1 : kind == 2 ? size[axis] : kind == 3 ? 3 * size[axis] : kFar;
    if (kind != 0 && chance(random, 0.6)) step[axis] = uniformInt(random, -reach, reach);
  }
  return step;
}

inline std::string describe(const VoxelIndex& v) {
  std::ostringstream text;
  text << "(" << v.x() << ", " << v.y() << ", " << v.z() << ")";
  return text.str();
}

inline std::string describe(const VoxelBox& box) {
  return "[" + describe(box.min) + ", " + describe(box.max) + ")";
}

struct VoxelLess {
  bool operator()(const VoxelIndex& a, const VoxelIndex& b) const {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  }
};

using VoxelSet = std::set<VoxelIndex, VoxelLess>;

/// Calls visit(VoxelIndex) for every voxel of a box.
template <typename Visitor>
void forEachVoxel(const VoxelBox& box, Visitor&& visit) {
  for (int x = box.min.x(); x < box.max.x(); ++x) {
    for (int y = box.min.y(); y < box.max.y(); ++y) {
      for (int z = box.min.z(); z < box.max.z(); ++z) visit(VoxelIndex(x, y, z));
    }
  }
}

/// One flag for every voxel of a box.
class VoxelField {
 public:
  explicit VoxelField(const VoxelBox& box)
      : box_(box), size_(box.size()), flags_(static_cast<std::size_t>(box.volume()), 0) {}

  const VoxelBox& box() const { return box_; }
  bool at(const VoxelIndex& v) const { return flags_[indexOf(v)] != 0; }
  /// Voxels outside of the box are ignored.
  void mark(const VoxelIndex& v) {
    if (box_.contains(v)) flags_[indexOf(v)] = 1;
  }
  std::int64_t count() const { return std::count(flags_.begin(), flags_.end(), 1); }
  bool operator==(const VoxelField& other) const {
    return box_ == other.box_ && flags_ == other.flags_;
  }

 private:
  std::size_t indexOf(const VoxelIndex& v) const {
    const VoxelIndex d = v - box_.min;
    return (static_cast<std::size_t>(d.x()) * size_.y() + d.y()) * size_.z() + d.z();
  }

  VoxelBox box_;
  VoxelIndex size_;
  std::vector<char> flags_;
};

inline std::string nameOf(ElementShape shape) {
  return shape == ElementShape::kBall ? "ball" : shape == ElementShape::kCube ? "cube" : "diamond";
}

/// The structuring element's definition in whole millimetres: integer arithmetic, so no rounding.
struct ElementDefinition {
  ElementShape shape = ElementShape::kBall;
  int radius_mm = 0;
  int resolution_mm = 100;

  double radius() const { return radius_mm / 1000.0; }
  double resolution() const { return resolution_mm / 1000.0; }
  /// L rounded up to whole voxels.
  int ceilOfRadius() const { return (radius_mm + resolution_mm - 1) / resolution_mm; }

  bool contains(const VoxelIndex& d) const {
    const int ax = std::abs(d.x()), ay = std::abs(d.y()), az = std::abs(d.z());
    switch (shape) {
      case ElementShape::kBall:
        return (ax * ax + ay * ay + az * az) * resolution_mm * resolution_mm <=
               radius_mm * radius_mm;
      case ElementShape::kCube:
        return std::max({ax, ay, az}) <= ceilOfRadius();
      case ElementShape::kDiamond:
        return ax + ay + az <= ceilOfRadius();
    }
    return false;
  }

  /// In lexicographic order.
  std::vector<VoxelIndex> offsets() const {
    const VoxelIndex reach = VoxelIndex::Constant(ceilOfRadius());
    std::vector<VoxelIndex> inside;
    forEachVoxel({-reach, reach + VoxelIndex::Ones()}, [&](const VoxelIndex& d) {
      if (contains(d)) inside.push_back(d);
    });
    return inside;
  }
};

/// inflated = occupied dilated by the element, clipped to the window.
inline VoxelField dilate(const VoxelSet& occupied, const std::vector<VoxelIndex>& offsets,
                         const VoxelBox& window) {
  VoxelField inflated(window);
  for (const VoxelIndex& u : occupied) {
    for (const VoxelIndex& d : offsets) inflated.mark(u + d);
  }
  return inflated;
}

/// Set bits of a plane in all of the grid's memory, inside of the window or not.
inline std::int64_t countBits(const SlidingGrid& grid, Plane plane) {
  std::int64_t bits = 0;
  for (const int slot : grid.liveSlots()) {
    const VoxelIndex origin = grid.tileOrigin(slot);
    for (int i = 0; i < kTileColumns; ++i) {
      const std::uint64_t* words =
          grid.column(plane, origin.x() + i / kTileSide, origin.y() + i % kTileSide);
      forEachBit(words, grid.layout().words(), [&](int) { ++bits; });
    }
  }
  return bits;
}

/// Compares a plane of the grid with its expected state: every voxel of the window, its count, and
/// that nothing is set outside of the window.
inline ::testing::AssertionResult planeEquals(const SlidingGrid& grid, Plane plane,
                                              const VoxelField& expected) {
  if (grid.window() != expected.box()) {
    return ::testing::AssertionFailure()
           << "window is " << describe(grid.window()) << ", not " << describe(expected.box());
  }
  int missing = 0, spurious = 0;
  std::string example;
  forEachVoxel(expected.box(), [&](const VoxelIndex& v) {
    const bool is_set = grid.test(plane, v);
    if (is_set == expected.at(v)) return;
    ++(is_set ? spurious : missing);
    if (example.empty()) example = describe(v) + (is_set ? " is set" : " is not set");
  });
  if (missing + spurious > 0) {
    return ::testing::AssertionFailure()
           << missing << " voxels missing, " << spurious << " spurious in window "
           << describe(grid.window()) << ", first: " << example;
  }
  // Every voxel of the window is right, so whatever there is more lies outside of it.
  const std::int64_t bits = countBits(grid, plane);
  if (grid.count(plane) != expected.count() || bits != expected.count()) {
    return ::testing::AssertionFailure() << "count() is " << grid.count(plane) << ", bits in all "
                                         << bits << ", expected " << expected.count();
  }
  return ::testing::AssertionSuccess();
}

}  // namespace fiimap::test
