#include "agreement.h"

#include <array>
#include <cstdio>
#include <set>

#include "inflation_replay.h"
#include "mapping_method.h"

namespace fiimap::bench {
namespace {

constexpr double kCheckedResolution = 0.1;  // m
constexpr int kCheckedReach = 2;            // voxels
/// Measured: at least .997 on the excerpt and in the kitchen. A baseline with its axes, frames or
/// probabilities mixed up falls far below.
constexpr double kMinShareFound = 0.95;

using VoxelSet = std::set<std::array<int, 3>>;

VoxelSet setOf(const std::vector<VoxelIndex>& voxels) {
  VoxelSet set;
  for (const VoxelIndex& v : voxels) set.insert({v.x(), v.y(), v.z()});
  return set;
}

bool hasNear(const VoxelSet& set, const std::array<int, 3>& v) {
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        if (set.count({v[0] + dx, v[1] + dy, v[2] + dz}) > 0) return true;
      }
    }
  }
  return false;
}

/// Share of the voxels that have one of `others` within one voxel.
double shareFound(const VoxelSet& voxels, const VoxelSet& others) {
  std::size_t found = 0;
  for (const auto& v : voxels) found += hasNear(others, v) ? 1 : 0;
  return voxels.empty() ? 0.0 : static_cast<double>(found) / voxels.size();
}

/// Voxels in which the two inflated layers differ, where the batch knows all obstacles around.
std::size_t differences(const InflaterReplay& ours, const BatchReplay& batch, const VoxelBox& box) {
  const VoxelBox inner{box.min.array() + kCheckedReach, box.max.array() - kCheckedReach};
  std::size_t count = 0;
  for (int x = inner.min.x(); x < inner.max.x(); ++x) {
    for (int y = inner.min.y(); y < inner.max.y(); ++y) {
      for (int z = inner.min.z(); z < inner.max.z(); ++z) {
        const VoxelIndex v(x, y, z);
        count += ours.grid().test(Plane::kInflated, v) != batch.isInflated(v) ? 1 : 0;
      }
    }
  }
  return count;
}

bool inflationAgrees(const Recording& recording, const std::vector<InflationStep>& steps,
                     ElementShape shape, InflationMethod method, const char* name) {
  MapperConfig config = configAt(kCheckedResolution, kCheckedReach, shape);
  config.inflation_method = method;
  InflaterReplay ours(config);
  BatchReplay batch(config, boxAroundFrames(config, recording.frames));
  std::size_t differing = 0;
  for (const InflationStep& step : steps) {
    ours.prepare(step);
    ours.update();
    batch.prepare(step);
    batch.update();
    differing += differences(ours, batch, step.update_box);
  }
  const auto inflated = ours.grid().count(Plane::kInflated);
  std::printf("inflation %-16s against bytes: %zu voxels differ, %lld inflated at the end\n", name,
              differing, static_cast<long long>(inflated));
  return differing == 0 && inflated > 0;
}

bool occupancyAgrees(const Recording& recording) {
  const MapperConfig config = configAt(kCheckedResolution, kCheckedReach);
  const VoxelBox box = updateBox(config, recording.frames.back().pose);
  const auto occupied = [&](const char* name) {
    const auto method = makeMethod(name, config, recording.frames);
    for (const Frame& frame : recording.frames) method->integrate(frame);
    return setOf(method->occupied(box));
  };
  const VoxelSet ours = occupied(kFiimap);
  std::printf("occupied at the end in the last update box: %s %zu\n", kFiimap, ours.size());
  bool agree = !ours.empty();
  for (const char* name : {kEgoStyle, kEgoStyleAsShipped, kPerPixel, kOctomap}) {
    const VoxelSet theirs = occupied(name);
    const double ours_found = shareFound(ours, theirs);
    const double theirs_found = shareFound(theirs, ours);
    std::printf("  %-16s %zu; of ours it has %.3f, of its we have %.3f within one voxel\n", name,
                theirs.size(), ours_found, theirs_found);
    agree = agree && ours_found >= kMinShareFound && theirs_found >= kMinShareFound;
  }
  return agree;
}

}  // namespace

bool checkAgreement(const Recording& recording) {
  const std::vector<InflationStep> steps =
      recordInflationSteps(recording.frames, configAt(kCheckedResolution, kCheckedReach));
  bool agree = inflationAgrees(recording, steps, ElementShape::kCube, InflationMethod::kIncremental,
                               "incremental cube");
  agree &= inflationAgrees(recording, steps, ElementShape::kBall, InflationMethod::kIncremental,
                           "incremental ball");
  agree &=
      inflationAgrees(recording, steps, ElementShape::kCube, InflationMethod::kBfs, "bfs cube");
  agree &= occupancyAgrees(recording);
  std::printf("%s: methods %s\n", recording.name.c_str(), agree ? "agree" : "DISAGREE");
  return agree;
}

}  // namespace fiimap::bench
