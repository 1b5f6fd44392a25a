#include "truth_command.h"

#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "fiimap/mapper.h"
#include "fiimap/ros/scan_decoder.h"
#include "output_file.h"
#include "reading_projector.h"
#include "scan_evaluator.h"
#include "truth/passing_obstacles.h"
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
      candidates_.push_back({std::make_unique<Mapper>(changed),
                             {resolution, {}, {}, {}, {}},
                             PassedVoxels(resolution, config.max_ray_length),
                             PassingObstacles(scene_)});
    }
  }

  /// The last map at the first resolution: x, y, z, distance from the surface (m).
  void writeVoxels(const std::string& file) const {
    const std::shared_ptr<const Snapshot> map = candidates_.front().mapper->snapshot();
    std::ostringstream stream;
    stream << "x,y,z,distance\n";
    for (const VoxelIndex& v : map->voxels(Plane::kOccupied, map->window())) {
      const Eigen::Vector3d center_W = map->lattice().centerOf(v);
      stream << center_W.x() << ',' << center_W.y() << ',' << center_W.z() << ','
             << scene_.signedDistance(center_W, time_) << '\n';
    }
    writeWhole(file, stream.str());
  }

  std::vector<TruthRow> rows() const {
    std::vector<TruthRow> rows;
    for (const Candidate& candidate : candidates_) {
      rows.push_back(candidate.row);
      rows.back().obstacles = candidate.obstacles.json();
    }
    return rows;
  }

 private:
  struct Candidate {
    std::unique_ptr<Mapper> mapper;
    TruthRow row;
    PassedVoxels passed;
    PassingObstacles obstacles;
  };

  void addScan(const SynchronizedScan& scan, std::size_t index) override {
    for (Candidate& candidate : candidates_) decoder_.integrate(scan, candidate.mapper.get());
    time_ = scan.pose.stamp_ns * kNanosecond - scene_.startTime();
    projector_.project(scan, &readings_);
    surface_.add(readings_, time_);
    const std::size_t due = (index + 1) * snapshots_ / total();
    for (Candidate& candidate : candidates_) {
      const std::shared_ptr<const Snapshot> map = candidate.mapper->snapshot();
      candidate.passed.add(readings_, scene_, time_);
      candidate.obstacles.add(readings_, *map, time_);
      if (due > taken_) compare(*map, time_, &candidate);
    }
    taken_ = due;
  }

  void compare(const Snapshot& map, double time, Candidate* candidate) {
    const VoxelBox box = VoxelLattice::boxAround(map.lattice().indexOf(readings_.origin),
                                                 map.lattice().sizeOf(kBoxSize));
    TruthRow& row = candidate->row;
    compareWithScene(map, scene_, surface_, box, time, &row.count);
    candidate->passed.compare(map, scene_, box, time, &row.free_space);
    row.inflation.compare(map, scene_, surface_, box, time);
  }

  void forget() override {
    throw std::runtime_error("the recording begins anew, which its scene does not");
  }

  ExactScene scene_;
  SeenSurface surface_;
  ReadingProjector projector_;
  ScanDecoder decoder_;
  RangeData readings_;
  std::vector<Candidate> candidates_;
  double time_ = 0.0;  // of the scene, s
  std::size_t snapshots_;
  std::size_t taken_ = 0;
};

}  // namespace

int evaluateTruth(const TruthOptions& options) {
  if (options.scene.empty()) throw std::invalid_argument("truth needs --scene FILE");
  if (options.snapshots < 1) throw std::invalid_argument("--snapshots must be at least 1");
  const EvaluationInput input(options.input);
  input.requireOneSensor();
  if (!options.voxels.empty()) checkWritable(options.voxels);
  std::vector<double> resolutions = options.resolutions;
  if (resolutions.empty()) resolutions = {input.mapper().resolution};
  TruthComparison comparison(input.mapper(), resolutions, ExactScene::load(options.scene),
                             options.snapshots);
  comparison.play(input);

  comparison.printWarnings();
  if (!options.voxels.empty()) comparison.writeVoxels(options.voxels);
  const std::vector<TruthRow> rows = comparison.rows();
  std::cout << toText(rows, options.csv);
  nlohmann::json json = toJson(comparison.counters());
  json["warnings"] = comparison.warnings();
  json["scene"] = options.scene;
  json["results"] = nlohmann::json::array();
  for (const TruthRow& row : rows) json["results"].push_back(toJson(row));
  input.writeJson(json);
  return 0;
}

}  // namespace fiimap
