#include "truth_command.h"

#include <iostream>
#include <memory>
#include <stdexcept>

#include "fiimap/mapper.h"
#include "fiimap/ros/scan_decoder.h"
#include "reading_projector.h"
#include "scan_evaluator.h"
#include "truth_report.h"

namespace fiimap {
namespace {

constexpr double kNanosecond = 1e-9;  // s
constexpr int kSurfaceStep = 4;       // pixels between the rays that look for the surface
const Eigen::Vector3d kBoxSize(16.0, 16.0, 6.0);  // m around the sensor

/// Builds one map per resolution and compares them with the scene now and then.
class TruthComparison : public ScanEvaluator {
 public:
  TruthComparison(const MapperConfig& config, const std::vector<double>& resolutions,
                  const ExactScene& scene, int snapshots)
      : scene_(scene),
        surface_(scene_, config.max_ray_length),
        projector_(config, kSurfaceStep),
        snapshots_(snapshots) {
    for (const double resolution : resolutions) {
      MapperConfig changed = config;
      changed.resolution = resolution;
      mappers_.push_back(std::make_unique<Mapper>(changed));
      rows_.push_back({resolution, {}});
    }
  }

  const std::vector<TruthRow>& rows() const { return rows_; }

 private:
  void addScan(const SynchronizedScan& scan, std::size_t index) override {
    for (const auto& mapper : mappers_) decoder_.integrate(scan, mapper.get());
    const double time = scan.pose.stamp_ns * kNanosecond - scene_.startTime();
    projector_.project(scan, &readings_);
    surface_.add(readings_, time);
    const std::size_t due = (index + 1) * snapshots_ / total();
    if (due > taken_) compare(time);
    taken_ = due;
  }

  void compare(double time) {
    for (std::size_t i = 0; i < mappers_.size(); ++i) {
      const std::shared_ptr<const Snapshot> map = mappers_[i]->snapshot();
      const VoxelBox box = VoxelLattice::boxAround(map->lattice().indexOf(readings_.origin),
                                                   map->lattice().sizeOf(kBoxSize));
      compareWithScene(*map, scene_, surface_, box, time, &rows_[i].count);
    }
  }

  void forget() override {
    throw std::runtime_error("the recording begins anew, which its scene does not");
  }

  ExactScene scene_;
  SeenSurface surface_;
  ReadingProjector projector_;
  ScanDecoder decoder_;
  RangeData readings_;
  std::vector<std::unique_ptr<Mapper>> mappers_;
  std::vector<TruthRow> rows_;
  std::size_t snapshots_;
  std::size_t taken_ = 0;
};

}  // namespace

int evaluateTruth(const TruthOptions& options) {
  if (options.scene.empty()) throw std::invalid_argument("truth needs --scene FILE");
  if (options.snapshots < 1) throw std::invalid_argument("--snapshots must be at least 1");
  const EvaluationInput input(options.input);
  std::vector<double> resolutions = options.resolutions;
  if (resolutions.empty()) resolutions = {input.mapper().resolution};
  TruthComparison comparison(input.mapper(), resolutions, ExactScene::load(options.scene),
                             options.snapshots);
  comparison.play(input);

  comparison.printWarnings();
  std::cout << toText(comparison.rows(), options.csv);
  nlohmann::json json = toJson(comparison.counters());
  json["warnings"] = comparison.warnings();
  json["scene"] = options.scene;
  json["results"] = nlohmann::json::array();
  for (const TruthRow& row : comparison.rows()) json["results"].push_back(toJson(row));
  input.writeJson(json);
  if (comparison.counters().integrated == 0) {
    std::cerr << "error: no scan could be integrated\n";
    return 1;
  }
  return 0;
}

}  // namespace fiimap
