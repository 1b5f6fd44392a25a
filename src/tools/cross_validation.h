#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accuracy_report.h"
#include "fiimap/mapper_config.h"
#include "held_out_split.h"
#include "map_agreement.h"
#include "reading_projector.h"
#include "scan_evaluator.h"

namespace fiimap {

/// A map that is built from scans and has to foretell others.
class ForetellingMap {
 public:
  virtual ~ForetellingMap() = default;

  /// \throws InputError when the scan cannot be used.
  virtual void add(const SynchronizedScan& scan) = 0;
  virtual void reset() = 0;
  /// Valid until the next scan is added.
  virtual OccupancyQuery query() = 0;
  virtual double resolution() const = 0;
  virtual std::string method() const = 0;
};

/// Cross-validation in one pass through a recording: for every split, method and resolution a map
/// of the scans that the split does not hold out.
class CrossValidation : public ScanEvaluator {
 public:
  /// \param held_out_step of the pixels that are looked at in held-out scans.
  /// \param octomap whether to build an OctoMap beside each map.
  CrossValidation(const MapperConfig& config, const std::vector<double>& resolutions,
                  const std::vector<HeldOutSplit>& splits, int held_out_step, bool octomap);
  ~CrossValidation() override;

  /// `final_map`: the map that all building scans of the recording made, against every held-out
  /// scan. `online`: the map of the building scans before the held-out scan, as a vehicle has it
  /// when it takes that scan. Scans of all splits count alike.
  std::vector<AccuracyRow> rows() const;
  /// Of the maps of the first split, by resolution; empty without OctoMap.
  std::vector<MapAgreement> agreements() const;
  /// Over all splits.
  std::size_t heldOut() const;

 private:
  struct Candidate {
    std::unique_ptr<ForetellingMap> map;
    std::vector<ScanPrediction> online;
  };
  /// What belongs to one split.
  struct Fold {
    HeldOutSplit split;
    std::vector<Candidate> candidates;  // of every fold in the same order
    std::vector<RangeData> held_out;
  };

  void addScan(const SynchronizedScan& scan, std::size_t index) override;
  void addTo(Fold* fold, const SynchronizedScan& scan, std::size_t index);
  void forget() override;

  ReadingProjector projector_;
  std::vector<Fold> folds_;
};

}  // namespace fiimap
