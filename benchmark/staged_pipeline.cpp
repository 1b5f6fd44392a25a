#include "staged_pipeline.h"

#include "thread_clock.h"

namespace fiimap::bench {

StagedPipeline::StagedPipeline(const MapperConfig& config, const std::vector<Frame>& frames)
    : config_(config),
      frames_(frames),
      projector_(config),
      ray_caster_(VoxelLattice(config.resolution), config.ray_end_cut, config.min_hit_cover,
                  config.round_rays),
      integrator_(LogOdds(config)),
      inflater_(makeInflater(config)),
      grid_(VoxelLattice(config.resolution).sizeOf(config.mapSize())) {
  Mapper mapper(config);
  for (const Frame& frame : frames_) {
    mapper.integrate(frame.image.view, frame.intrinsics, frame.pose);
    windows_.push_back(mapper.grid().window());
  }
}

std::array<double, kStageCount> StagedPipeline::integrateNext() {
  const Frame& frame = frames_[next_];
  const VoxelBox& window = windows_[next_];
  ++next_;
  std::array<double, kStageCount> times;
  const auto measure = [&](Stage stage, auto&& call) {
    times[static_cast<int>(stage)] = microsecondsOf(call);
  };
  measure(Stage::kProject, [&] {
    projector_.project(frame.image.view, frame.intrinsics, frame.pose.T_W_S, &scan_);
  });
  changes_.clear();
  measure(Stage::kSlide, [&] { grid_.moveTo(window.min, &changes_); });
  measure(Stage::kCast, [&] {
    ray_caster_.cast(scan_, updateBox(config_, frame.pose).intersection(window), &mask_);
  });
  measure(Stage::kFuse, [&] { integrator_.apply(mask_, &grid_, &changes_); });
  measure(Stage::kInflate, [&] { inflater_->update(changes_, &grid_); });
  Snapshot::Info info;
  info.resolution = config_.resolution;
  measure(Stage::kSnapshot, [&] { snapshot_ = std::make_shared<const Snapshot>(&grid_, info); });
  return times;
}

}  // namespace fiimap::bench
