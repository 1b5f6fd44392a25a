#include "fiimap/mapper.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiimap/parameters.h"

#include "overwrite.h"

namespace fiimap {
namespace {

/// Measures consecutive stages: each call of lap() returns the milliseconds since the last one.
class Stopwatch {
 public:
  double lap() {
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double, std::milli> elapsed = now - start_;
    start_ = now;
    return elapsed.count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

const MapperConfig& validated(const MapperConfig& config) {
  config.validate();
  return config;
}

void requireValid(const DepthImage& image, const PinholeIntrinsics& intrinsics) {
  const std::size_t pixel_bytes = image.format == DepthImage::Format::kUint16 ? 2 : 4;
  if (image.data == nullptr || image.width <= 0 || image.height <= 0 ||
      image.row_bytes < image.width * pixel_bytes) {
    throw std::invalid_argument("depth image: no pixels, or rows shorter than its width");
  }
  if (!intrinsics.valid()) {
    throw std::invalid_argument("camera intrinsics: focal lengths must be positive and finite");
  }
}

/// Parameters are bound to their configuration, so both are copies.
void refuseFixedChanges(MapperConfig from, MapperConfig to) {
  const auto refuse = [](const std::string& name, const std::string& value,
                         const std::string& fixed) {
    throw std::invalid_argument("parameter " + name + " = '" + value + "': must stay '" + fixed +
                                "' while the map is in use");
  };
  const std::vector<Parameter> before = mapperParameters(&from), after = mapperParameters(&to);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool may_differ = before[i].tunable || before[i].get() == after[i].get();
    if (!may_differ) refuse(before[i].name, after[i].get(), before[i].get());
  }
  if (from.sensorCount() != to.sensorCount()) {
    refuse("sensors", std::to_string(to.sensorCount()), std::to_string(from.sensorCount()));
  }
}

constexpr double kRotationTolerance = 1e-3;

bool isRotation(const Eigen::Matrix3d& R) {
  return R.allFinite() && R.isUnitary(kRotationTolerance) && R.determinant() > 0.0;
}

void requireValid(const ScanPose& pose, const VoxelLattice& lattice) {
  if (!lattice.canIndex(pose.vehicle_W) || !lattice.canIndex(pose.T_W_S.translation())) {
    throw std::invalid_argument("pose: position is not finite or too far from the origin");
  }
  if (!isRotation(pose.T_W_S.linear()) || !isRotation(pose.R_W_B)) {
    throw std::invalid_argument("pose: orientation is not a rotation");
  }
}

}  // namespace

Eigen::Isometry3d ScanPose::T_W_B() const {
  Eigen::Isometry3d T_W_B = Eigen::Isometry3d::Identity();
  T_W_B.linear() = R_W_B;
  T_W_B.translation() = vehicle_W;
  return T_W_B;
}

Mapper::Mapper(const MapperConfig& config)
    : config_(validated(config)),
      lattice_(config.resolution),
      grid_(lattice_.sizeOf(config.mapSize())),
      stages_(std::make_unique<Stages>(config)),
      ignored_(config.bodySize()),
      decay_(config.decay_time) {
  grid_.keepSeen(config.decay_time > 0.0);
}

Mapper::Stages::Stages(const MapperConfig& config)
    : ray_caster(VoxelLattice(config.resolution), config.ray_end_cut, config.min_hit_cover,
                 config.round_rays),
      integrator(LogOdds(config)),
      inflater(makeInflater(config)) {
  for (std::size_t sensor = 0; sensor < config.sensorCount(); ++sensor) {
    const MapperConfig own = config.withOnly(sensor);
    projectors.push_back({DepthProjector(own), PointProjector(own)});
  }
}

ScanReport Mapper::integrate(const DepthImage& image, const PinholeIntrinsics& intrinsics,
                             const ScanPose& pose, std::size_t sensor) {
  requireValid(image, intrinsics);
  requireValid(pose, lattice_);
  Stopwatch stopwatch;
  ScanReport report;
  report.readings =
      stages_->projectors.at(sensor).depth.project(image, intrinsics, pose.T_W_S, &scan_);
  report.times_ms.project = stopwatch.lap();
  return integrateScan(pose, report);
}

ScanReport Mapper::integrate(const PointScan& points, const ScanPose& pose, std::size_t sensor) {
  requireValid(pose, lattice_);
  Stopwatch stopwatch;
  ScanReport report;
  report.readings = stages_->projectors.at(sensor).points.project(points, pose.T_W_S, &scan_);
  report.times_ms.project = stopwatch.lap();
  return integrateScan(pose, report);
}

/// The main loop of the map: everything between a scan in the world frame and exact inflation.
ScanReport Mapper::integrateScan(const ScanPose& pose, ScanReport report) {
  Stopwatch stopwatch;
  report.readings.ignored = ignored_.removeReturns(pose.T_W_B(), pose.stamp_ns, &scan_);
  report.readings.returns -= report.readings.ignored;
  report.times_ms.project += stopwatch.lap();

  const VoxelIndex vehicle = lattice_.indexOf(pose.vehicle_W);

  changes_.clear();
  // A sensor whose scans take longer must not turn the window back.
  const bool is_newest = !window_placed_ || pose.stamp_ns >= stamp_ns_;
  if (is_newest) {
    stamp_ns_ = pose.stamp_ns;
    follow(vehicle);
  }
  report.times_ms.slide = stopwatch.lap();

  const VoxelIndex update_range = lattice_.sizeOf(config_.localUpdateRange());
  report.update_box = VoxelLattice::boxAround(vehicle, update_range).intersection(grid_.window());
  report.rays = stages_->ray_caster.cast(scan_, report.update_box, &mask_);
  if (config_.clear_body) ignored_.freeBody(pose.T_W_B(), lattice_, &mask_);
  report.times_ms.raycast = stopwatch.lap();

  stages_->integrator.apply(mask_, &grid_, &changes_);
  decay_.advance(pose.stamp_ns, &grid_, &changes_);
  report.times_ms.fuse = stopwatch.lap();

  stages_->inflater->update(changes_, &grid_);
  report.times_ms.inflate = stopwatch.lap();

  report.raise = changes_.raise.size();
  report.lower = changes_.lower.size();
  report.forgotten = changes_.forgotten.size();
  return report;
}

/// Moves the window after the vehicle, on each axis on its own, when it left the middle too far.
void Mapper::follow(const VoxelIndex& vehicle) {
  const VoxelIndex size = grid_.window().size();
  VoxelIndex center = grid_.window().min + size / 2;
  if (!window_placed_) {
    const bool sliding = config_.map_mode == MapMode::kSliding;
    center = sliding ? vehicle : lattice_.indexOf(config_.mapCenter());
    window_placed_ = true;
  } else if (config_.map_mode == MapMode::kSliding) {
    const int trigger =
        std::max(1, static_cast<int>(std::lround(config_.slide_distance / config_.resolution)));
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(vehicle[axis] - center[axis]) >= trigger) center[axis] = vehicle[axis];
    }
  }
  grid_.moveTo(VoxelLattice::boxAround(center, size).min, &changes_);
}

std::shared_ptr<const Snapshot> Mapper::snapshot() {
  Snapshot::Info info;
  info.stamp_ns = stamp_ns_;
  info.sequence = ++sequence_;
  info.resolution = config_.resolution;
  info.inflation_shape = config_.inflation_shape;
  info.inflation_radius = config_.inflation_radius;
  if (config_.virtual_walls) info.walls = {config_.virtual_floor, config_.virtual_ceiling};
  return std::make_shared<const Snapshot>(&grid_, info);
}

void Mapper::reset() {
  grid_.clear();
  ignored_.forgetSpheres();
  decay_.restart();
  window_placed_ = false;
  stamp_ns_ = 0;
}

void Mapper::reconfigure(const MapperConfig& config) {
  config.validate();
  refuseFixedChanges(config_, config);
  auto stages = std::make_unique<Stages>(config);
  const bool keeps_element = config.inflation_shape == config_.inflation_shape &&
                             config.inflation_radius == config_.inflation_radius;

  changes_.clear();
  stages->integrator.convert(logOdds(), &grid_, &changes_);
  if (keeps_element) {
    stages->inflater->update(changes_, &grid_);
  } else {
    rebuildInflation(stages->inflater.get(), &grid_);
  }
  stages_ = std::move(stages);
  ignored_.setBody(config.bodySize());
  if (config.decay_time != config_.decay_time) {
    decay_.setTime(config.decay_time);
    grid_.keepSeen(config.decay_time > 0.0);
  }
  config_ = config;
}

std::int64_t Mapper::overwrite(const std::vector<VoxelBox>& boxes, Occupancy state) {
  if (state == Occupancy::kOutside) {
    throw std::invalid_argument("voxels cannot be made to lie outside of the window");
  }
  if (!window_placed_) return 0;
  std::int64_t voxels = 0;
  changes_.clear();
  for (const VoxelBox& box : boxes) {
    voxels += box.intersection(grid_.window()).volume();
    fiimap::overwrite(box, state, logOdds(), &grid_, &changes_);
  }
  stages_->inflater->update(changes_, &grid_);
  return voxels;
}

void Mapper::placeWindow(const Eigen::Vector3d& vehicle_W) {
  if (!lattice_.canIndex(vehicle_W)) {
    throw std::invalid_argument("position of the vehicle: not finite or too far from the origin");
  }
  if (window_placed_) return;
  changes_.clear();  // nothing is known yet, so nothing is left behind
  follow(lattice_.indexOf(vehicle_W));
}

std::size_t Mapper::memoryBytes() const { return grid_.memoryBytes() + mask_.memoryBytes(); }

}  // namespace fiimap
