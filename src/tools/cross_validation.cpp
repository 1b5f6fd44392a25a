#include "cross_validation.h"

#include <utility>

#include "baselines/octomap_map.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/scan_decoder.h"

namespace fiimap {
namespace {

class FiimapCandidate : public ForetellingMap {
 public:
  explicit FiimapCandidate(const MapperConfig& config) : mapper_(config) {}

  void add(const SynchronizedScan& scan) override { decoder_.integrate(scan, &mapper_); }
  void reset() override { mapper_.reset(); }
  OccupancyQuery query() override {
    return [map = mapper_.snapshot()](const VoxelIndex& v) { return map->occupancy(v); };
  }
  double resolution() const override { return mapper_.config().resolution; }
  std::string method() const override { return "fiimap"; }
  std::shared_ptr<const Snapshot> snapshot() { return mapper_.snapshot(); }

 private:
  Mapper mapper_;
  ScanDecoder decoder_;
};

class OctomapCandidate : public ForetellingMap {
 public:
  explicit OctomapCandidate(const MapperConfig& config)
      : config_(config), map_(std::make_unique<bench::OctomapMap>(config)) {}

  void add(const SynchronizedScan& scan) override {
    map_->integrate(bench::frameOf(scan, config_.pixel_step));
  }
  void reset() override { map_ = std::make_unique<bench::OctomapMap>(config_); }
  OccupancyQuery query() override {
    return [this](const VoxelIndex& v) { return map_->occupancy(v); };
  }
  double resolution() const override { return config_.resolution; }
  std::string method() const override { return "octomap"; }
  const bench::OctomapMap& map() const { return *map_; }

 private:
  MapperConfig config_;
  std::unique_ptr<bench::OctomapMap> map_;
};

}  // namespace

CrossValidation::CrossValidation(const MapperConfig& config, const std::vector<double>& resolutions,
                                 const std::vector<HeldOutSplit>& splits, int held_out_step,
                                 bool octomap)
    : projector_(config, held_out_step) {
  for (const HeldOutSplit& split : splits) {
    Fold fold{split, {}, {}};
    for (const double resolution : resolutions) {
      MapperConfig changed = config;
      changed.resolution = resolution;
      fold.candidates.push_back({std::make_unique<FiimapCandidate>(changed), {}});
      if (octomap) fold.candidates.push_back({std::make_unique<OctomapCandidate>(changed), {}});
    }
    folds_.push_back(std::move(fold));
  }
}

CrossValidation::~CrossValidation() = default;

std::vector<AccuracyRow> CrossValidation::rows() const {
  std::vector<AccuracyRow> rows;
  for (std::size_t i = 0; i < folds_.front().candidates.size(); ++i) {
    const ForetellingMap& first = *folds_.front().candidates[i].map;
    std::vector<ScanPrediction> final_map, online;
    for (const Fold& fold : folds_) {
      const Candidate& candidate = fold.candidates[i];
      const OccupancyQuery query = candidate.map->query();
      const VoxelLattice lattice(candidate.map->resolution());
      for (const RangeData& scan : fold.held_out) {
        final_map.push_back(predict(query, lattice, scan));
      }
      online.insert(online.end(), candidate.online.begin(), candidate.online.end());
    }
    rows.push_back(summarise(first.method(), "final_map", first.resolution(), final_map));
    rows.push_back(summarise(first.method(), "online", first.resolution(), online));
  }
  return rows;
}

std::vector<MapAgreement> CrossValidation::agreements() const {
  std::vector<MapAgreement> agreements;
  FiimapCandidate* ours = nullptr;
  for (const Candidate& candidate : folds_.front().candidates) {
    if (auto* fiimap = dynamic_cast<FiimapCandidate*>(candidate.map.get())) ours = fiimap;
    if (auto* octomap = dynamic_cast<OctomapCandidate*>(candidate.map.get())) {
      agreements.push_back(compareWithOctomap(*ours->snapshot(), octomap->map()));
    }
  }
  return agreements;
}

std::size_t CrossValidation::heldOut() const {
  std::size_t count = 0;
  for (const Fold& fold : folds_) count += fold.held_out.size();
  return count;
}

void CrossValidation::addScan(const SynchronizedScan& scan, std::size_t index) {
  for (Fold& fold : folds_) addTo(&fold, scan, index);
}

void CrossValidation::addTo(Fold* fold, const SynchronizedScan& scan, std::size_t index) {
  if (!fold->split.holdsOut(index)) {
    for (Candidate& candidate : fold->candidates) candidate.map->add(scan);
    return;
  }
  RangeData readings;
  projector_.project(scan, &readings);
  readings.misses = {};  // not looked at, and all held-out scans are kept
  for (Candidate& candidate : fold->candidates) {
    const VoxelLattice lattice(candidate.map->resolution());
    candidate.online.push_back(predict(candidate.map->query(), lattice, readings));
  }
  fold->held_out.push_back(std::move(readings));
}

void CrossValidation::forget() {
  for (Fold& fold : folds_) {
    fold.held_out.clear();
    for (Candidate& candidate : fold.candidates) {
      candidate.map->reset();
      candidate.online.clear();
    }
  }
}

}  // namespace fiimap
