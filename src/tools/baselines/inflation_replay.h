#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "batch_inflation.h"
#include "fiimap/inflater.h"
#include "mapping_method.h"

namespace fiimap::bench {

/// What one frame did to the occupied plane: the input of an inflation.
struct InflationStep {
  VoxelBox window;
  VoxelBox update_box;  ///< the part of the window that the frame could change
  std::vector<VoxelIndex> lower;
  std::vector<VoxelIndex> raise;
  std::vector<VoxelIndex> forgotten;

  std::size_t score() const { return lower.size() + raise.size(); }
};

/// Builds a map and notes how its occupied plane changes.
class InflationRecorder {
 public:
  explicit InflationRecorder(const MapperConfig& config) : mapper_(config) {}

  /// \throws std::invalid_argument when the mapper refuses the frame.
  InflationStep add(const Frame& frame);

 private:
  Mapper mapper_;
  std::vector<VoxelIndex> before_;
};

/// The steps of all frames.
std::vector<InflationStep> recordInflationSteps(const std::vector<Frame>& frames,
                                                const MapperConfig& config);

/// One way to inflate, fed with recorded steps. prepare() brings the occupied plane up to date and
/// is not part of the inflation; update() is what is measured.
class InflationReplay {
 public:
  virtual ~InflationReplay() = default;
  virtual void prepare(const InflationStep& step) = 0;
  virtual void update() = 0;
  virtual bool isInflated(const VoxelIndex& v) const = 0;
};

/// One of our inflaters, as config.inflation_method says.
class InflaterReplay : public InflationReplay {
 public:
  explicit InflaterReplay(const MapperConfig& config);

  void prepare(const InflationStep& step) override;
  void update() override { inflater_->update(changes_, &grid_); }
  bool isInflated(const VoxelIndex& v) const override { return grid_.test(Plane::kInflated, v); }
  const SlidingGrid& grid() const { return grid_; }

 private:
  SlidingGrid grid_;
  std::unique_ptr<Inflater> inflater_;
  ChangeSet changes_;
};

/// Batch inflation over bytes of the update box.
class BatchReplay : public InflationReplay {
 public:
  /// \param box that holds the update boxes of all steps.
  BatchReplay(const MapperConfig& config, const VoxelBox& box);

  void prepare(const InflationStep& step) override;
  void update() override;
  bool isInflated(const VoxelIndex& v) const override { return inflated_[layout_.indexOf(v)] != 0; }

 private:
  void setOccupied(const std::vector<VoxelIndex>& voxels, std::uint8_t value);

  ArrayLayout layout_;
  BatchInflation inflation_;
  std::vector<std::uint8_t> occupied_;
  std::vector<std::uint8_t> inflated_;
  VoxelBox update_box_;
};

/// Ways to inflate: ours (those of the parameter inflation_method), then the baseline.
constexpr const char* kInflations[] = {"incremental", "bfs6",  "bfs18",
                                       "bfs26",       "batch", "byte_batch"};
constexpr char kByteBatch[] = "byte_batch";

/// \param name one of kInflations. \param box that holds the update boxes of all steps.
/// \throws std::invalid_argument for another name.
std::unique_ptr<InflationReplay> makeReplay(const std::string& name, MapperConfig config,
                                            const VoxelBox& box);

}  // namespace fiimap::bench
