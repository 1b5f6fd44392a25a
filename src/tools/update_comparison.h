#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baselines/inflation_replay.h"
#include "baselines/mapping_method.h"
#include "map_agreement.h"
#include "scan_evaluator.h"

namespace fiimap {

/// A method and what each update cost it.
struct MethodTimes {
  std::string name;
  bool inflation_only;  ///< false: from the readings to the map
  std::vector<double> times_us;
};

/// Smallest box of voxels that holds the update boxes of all scans of a recording.
class PathBox : public ScanEvaluator {
 public:
  explicit PathBox(const MapperConfig& config) : config_(config) {}
  const VoxelBox& box() const { return box_; }

 private:
  void addScan(const SynchronizedScan& scan, std::size_t /*index*/) override {
    box_ = bench::boxAround(box_, bench::updateBox(config_, scan.pose));
  }
  void forget() override {}

  MapperConfig config_;
  VoxelBox box_;
};

/// Runs methods over the scans of a recording, a block of scans at a time, in turns: each sees
/// every scan, and noise of the machine hits all of them alike.
class UpdateComparison : public ScanEvaluator {
 public:
  /// \param box that holds all update boxes, for methods that have arrays.
  UpdateComparison(const MapperConfig& config, const std::vector<std::string>& methods,
                   const VoxelBox& box);

  /// Measures what is left of the last block.
  void finish() { runBlock(); }

  /// Of every update, in their order.
  const std::vector<double>& changeScores() const { return change_scores_; }
  const std::vector<std::int64_t>& stampsNs() const { return stamps_ns_; }
  const std::vector<MethodTimes>& times() const { return times_; }
  /// At the end, when both fiimap and octomap took part.
  std::optional<MapAgreement> agreement() const;

 private:
  void addScan(const SynchronizedScan& scan, std::size_t index) override;
  void forget() override;
  void runBlock();
  double run(std::size_t method, std::size_t frame);

  MapperConfig config_;
  std::unique_ptr<bench::InflationRecorder> recorder_;
  // By method; one of the two is null.
  std::vector<std::unique_ptr<bench::InflationReplay>> replays_;
  std::vector<std::unique_ptr<bench::MappingMethod>> maps_;
  std::vector<MethodTimes> times_;
  std::vector<double> change_scores_;
  std::vector<std::int64_t> stamps_ns_;
  // The block that is being collected.
  std::vector<bench::Frame> frames_;
  std::vector<bench::InflationStep> steps_;
  std::size_t blocks_ = 0;
};

}  // namespace fiimap
