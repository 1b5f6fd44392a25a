#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mapping_method.h"

namespace fiimap::bench {

enum class Stage { kProject, kSlide, kCast, kFuse, kInflate, kSnapshot };
constexpr int kStageCount = 6;

/// The stages of the map one by one, with the CPU time that each takes. The windows are those of a
/// Mapper that saw the same frames before.
class StagedPipeline {
 public:
  StagedPipeline(const MapperConfig& config, const std::vector<Frame>& frames);

  /// Integrates the next frame; there must be one.
  /// \return microseconds by stage.
  std::array<double, kStageCount> integrateNext();

 private:
  MapperConfig config_;
  const std::vector<Frame>& frames_;
  std::vector<VoxelBox> windows_;
  std::size_t next_ = 0;

  DepthProjector projector_;
  RayCaster ray_caster_;
  ScanIntegrator integrator_;
  std::unique_ptr<Inflater> inflater_;
  SlidingGrid grid_;
  std::shared_ptr<const Snapshot> snapshot_;
  RangeData scan_;
  ScanMask mask_;
  ChangeSet changes_;
};

}  // namespace fiimap::bench
