#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fiimap/mapper.h"
#include "recording.h"

namespace fiimap::bench {

/// A way to make a map of depth images: ours or a baseline.
class MappingMethod {
 public:
  virtual ~MappingMethod() = default;

  /// From the depth image to the map that a planner reads.
  virtual void integrate(const Frame& frame) = 0;
  /// Occupied voxels of a box, in no particular order.
  virtual std::vector<VoxelIndex> occupied(const VoxelBox& box) const = 0;
};

/// This package's own map, snapshot included.
class FiimapMethod : public MappingMethod {
 public:
  explicit FiimapMethod(const MapperConfig& config) : mapper_(config) {}

  void integrate(const Frame& frame) override {
    bench::integrate(frame, &mapper_);
    snapshot_ = mapper_.snapshot();
  }
  std::vector<VoxelIndex> occupied(const VoxelBox& box) const override {
    return snapshot_->voxels(Plane::kOccupied, box);
  }
  /// Null before the first frame.
  const std::shared_ptr<const Snapshot>& snapshot() const { return snapshot_; }

 private:
  Mapper mapper_;
  std::shared_ptr<const Snapshot> snapshot_;
};

/// The defaults of the package at another resolution, with an inflation of `reach` voxels.
MapperConfig configAt(double resolution, int reach, ElementShape shape = ElementShape::kBall);

/// The box around the vehicle that a frame may change.
VoxelBox updateBox(const MapperConfig& config, const ScanPose& pose);

/// Smallest box that holds both; an empty one counts for nothing.
VoxelBox boxAround(const VoxelBox& a, const VoxelBox& b);

/// Smallest box that holds the update boxes of all frames: maps that cannot slide need it.
VoxelBox boxAroundFrames(const MapperConfig& config, const std::vector<Frame>& frames);

// Names of methods.
constexpr char kFiimap[] = "fiimap";
constexpr char kEgoStyle[] = "ego";
constexpr char kEgoStyleAsShipped[] = "ego_invalid_far";
constexpr char kPerPixel[] = "per_pixel";
constexpr char kOctomap[] = "octomap";

constexpr const char* kMappingMethods[] = {kFiimap, kEgoStyle, kEgoStyleAsShipped, kPerPixel,
                                           kOctomap};

/// Whether it is a method with arrays over a box that does not move.
bool isArrayMap(const std::string& name);

/// \param box that holds the update boxes of all frames that will be integrated; only methods with
/// arrays look at it.
/// \throws std::invalid_argument for a name that is not among kMappingMethods, or a box too large.
std::unique_ptr<MappingMethod> makeMethod(const std::string& name, const MapperConfig& config,
                                          const VoxelBox& box);

/// The same for frames in memory.
std::unique_ptr<MappingMethod> makeMethod(const std::string& name, const MapperConfig& config,
                                          const std::vector<Frame>& frames);

}  // namespace fiimap::bench
