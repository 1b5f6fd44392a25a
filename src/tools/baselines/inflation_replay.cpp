#include "inflation_replay.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace fiimap::bench {
namespace {

bool comesFirst(const VoxelIndex& a, const VoxelIndex& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

std::vector<VoxelIndex> sortedObstacles(const SlidingGrid& grid) {
  std::vector<VoxelIndex> obstacles;
  grid.forEach(Plane::kOccupied, grid.window(),
               [&](const VoxelIndex& v) { obstacles.push_back(v); });
  std::sort(obstacles.begin(), obstacles.end(), comesFirst);
  return obstacles;
}

/// Those of `a` that are not in `b`; both sorted.
std::vector<VoxelIndex> difference(const std::vector<VoxelIndex>& a,
                                   const std::vector<VoxelIndex>& b) {
  std::vector<VoxelIndex> result;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result),
                      comesFirst);
  return result;
}

}  // namespace

InflationStep InflationRecorder::add(const Frame& frame) {
  integrate(frame, &mapper_);
  InflationStep step;
  step.window = mapper_.grid().window();
  step.update_box = updateBox(mapper_.config(), frame.pose).intersection(step.window);
  std::vector<VoxelIndex> now = sortedObstacles(mapper_.grid());
  step.lower = difference(now, before_);
  for (const VoxelIndex& v : difference(before_, now)) {
    (step.window.contains(v) ? step.raise : step.forgotten).push_back(v);
  }
  before_ = std::move(now);
  return step;
}

std::vector<InflationStep> recordInflationSteps(const std::vector<Frame>& frames,
                                                const MapperConfig& config) {
  InflationRecorder recorder(config);
  std::vector<InflationStep> steps;
  for (const Frame& frame : frames) steps.push_back(recorder.add(frame));
  return steps;
}

InflaterReplay::InflaterReplay(const MapperConfig& config)
    : grid_(VoxelLattice(config.resolution).sizeOf(config.mapSize())),
      inflater_(makeInflater(config)) {}

void InflaterReplay::prepare(const InflationStep& step) {
  changes_.clear();
  grid_.moveTo(step.window.min, &changes_);
  for (const VoxelIndex& v : step.lower) grid_.set(Plane::kOccupied, v, true);
  for (const VoxelIndex& v : step.raise) grid_.set(Plane::kOccupied, v, false);
  changes_.lower = step.lower;
  changes_.raise = step.raise;
}

BatchReplay::BatchReplay(const MapperConfig& config, const VoxelBox& box)
    : layout_(box),
      inflation_(config.structuringElement(), layout_),
      occupied_(layout_.voxels(), 0),
      inflated_(layout_.voxels(), 0) {}

void BatchReplay::prepare(const InflationStep& step) {
  setOccupied(step.forgotten, 0);
  setOccupied(step.raise, 0);
  setOccupied(step.lower, 1);
  update_box_ = step.update_box;
}

void BatchReplay::update() {
  inflation_.inflate(
      update_box_, [this](std::size_t index) { return occupied_[index] != 0; }, &inflated_);
}

void BatchReplay::setOccupied(const std::vector<VoxelIndex>& voxels, std::uint8_t value) {
  for (const VoxelIndex& v : voxels) occupied_[layout_.indexOf(v)] = value;
}

std::unique_ptr<InflationReplay> makeReplay(const std::string& name, MapperConfig config,
                                            const VoxelBox& box) {
  if (name == kByteBatch) return std::make_unique<BatchReplay>(config, box);
  if (name == "incremental") {
    config.inflation_method = InflationMethod::kIncremental;
  } else if (name == "batch") {
    config.inflation_method = InflationMethod::kBatch;
  } else if (name == "bfs6" || name == "bfs18" || name == "bfs26") {
    config.inflation_method = InflationMethod::kBfs;
    config.bfs_connectivity = name == "bfs6" ? 6 : name == "bfs18" ? 18 : 26;
  } else {
    throw std::invalid_argument("no inflation method is called " + name);
  }
  return std::make_unique<InflaterReplay>(config);
}

}  // namespace fiimap::bench
