/// Travels kilometres with one map and its model side by side, and looks for differences.
///   fiimap_soak KILOMETRES [SEED]
/// Every scan goes into a small map and into the model of the property tests, which says for every
/// voxel what it must be; and into a large map, whose inflated layer is compared with brute force.
/// Slides on all axes, noise, teleports, resets and changes of parameters happen on the way. Fails
/// on the first difference, and when resident memory grew.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "../core/mapper_model.h"
#include "inflation_check.h"

namespace fiimap {
namespace {

using test::chance;
using test::ElementDefinition;
using test::Random;
using test::uniformInt;
using test::uniformReal;

constexpr double kStampStep = 1e-9;  // s, of a Journey
constexpr int kResolutionMm = 250;
constexpr double kReports = 20.0;
constexpr double kWarmUp = 0.2;  // of the way, until everything has been allocated once
constexpr double kMegabyte = 1e6;
/// Allocators keep and return memory in pieces; the maps hold some 10 MB.
constexpr double kMostGrowthMb = 4.0;

double residentMb() {
  std::ifstream stream("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  stream >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / kMegabyte;
}

MapperConfig smallConfig(const ElementDefinition& element) {
  MapperConfig config;
  config.resolution = element.resolution();
  config.map_size_x = config.map_size_y = 4.0;
  config.map_size_z = 2.0;
  config.local_update_range_x = config.local_update_range_y = config.local_update_range_z = 3.0;
  config.slide_distance = 0.5;
  config.max_depth = 100.0;
  config.max_ray_length = 3.0;
  config.ray_end_cut = 1.0;
  config.inflation_radius = element.radius();
  config.inflation_shape = element.shape;
  return config;
}

MapperConfig largeConfig() {
  MapperConfig config;
  config.map_size_x = config.map_size_y = 16.0;
  return config;
}

/// Obstacles around a vehicle that wanders, climbs and sinks, and sometimes is somewhere else.
class Journey {
 public:
  explicit Journey(Random* random) : random_(*random) {
    for (int i = 0; i < kObstacles; ++i) obstacles_.push_back(position_ + within(kSight));
  }

  double kilometres() const { return metres_ / 1000.0; }
  std::int64_t teleports() const { return teleports_; }

  ScanPose next() {
    if (chance(random_, 0.0005)) {
      position_ = within(kFar);
      ++teleports_;
    }
    if (chance(random_, 0.02)) velocity_ = within(0.15);
    const Eigen::Vector3d step = velocity_ + within(0.05);
    position_ += step;
    metres_ += step.norm();
    for (Eigen::Vector3d& obstacle : obstacles_) {
      if ((obstacle - position_).norm() > kSight || chance(random_, 0.002)) {
        obstacle = position_ + within(kSight);
      }
    }
    ScanPose pose;
    pose.vehicle_W = position_;
    pose.T_W_S.translation() = position_ + within(0.2);
    pose.T_W_S.linear() =
        Eigen::AngleAxisd(uniformReal(random_, -3.0, 3.0), within(1.0).normalized())
            .toRotationMatrix();
    pose.stamp_ns = ++stamp_;
    return pose;
  }

  /// Noisy points on obstacles, and outliers.
  std::vector<Eigen::Vector3d> look() {
    std::vector<Eigen::Vector3d> points_W;
    for (const Eigen::Vector3d& obstacle : obstacles_) {
      if (chance(random_, 0.8)) points_W.push_back(obstacle + within(0.05));
      if (chance(random_, 0.1)) points_W.push_back(position_ + within(8.0));
    }
    return points_W;
  }

 private:
  static constexpr int kObstacles = 10;
  static constexpr double kSight = 2.0, kFar = 1e6;  // m

  Eigen::Vector3d within(double reach) {
    return Eigen::Vector3d::NullaryExpr(
        [&](Eigen::Index) { return uniformReal(random_, -reach, reach); });
  }

  Random& random_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> obstacles_;
  double metres_ = 0.0;
  std::int64_t stamp_ = 0, teleports_ = 0;
};

class Soak {
 public:
  explicit Soak(unsigned seed)
      : random_(seed),
        journey_(&random_),
        small_(smallConfig(element_)),
        model_(small_.config()),
        large_(largeConfig()) {}

  /// \throws std::runtime_error on a difference.
  void travel(double kilometres) {
    double next_report = 0.0;
    while (journey_.kilometres() < kilometres) {
      step();
      if (journey_.kilometres() < next_report) continue;
      report();
      if (warm_mb_ == 0.0 && journey_.kilometres() > kWarmUp * kilometres) warm_mb_ = residentMb();
      next_report += kilometres / kReports;
    }
    report();
    // A sanitizer keeps what was freed.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    if (residentMb() > warm_mb_ + kMostGrowthMb) fail("resident memory grew");
#endif
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("scan " + std::to_string(scans_) + ": " + what);
  }

  void step() {
    ++scans_;
    if (chance(random_, 0.0005)) reset();
    if (chance(random_, 0.002)) reconfigure();
    const ScanPose pose = journey_.next();
    small_.integrate(PointScan(), pose);
    const VoxelBox window = small_.grid().window();
    model_.integrate(pose, {}, window);
    checkDecay();

    PointScan exact, all;
    std::vector<Eigen::Vector3d> points_W;
    const std::vector<Eigen::Vector3d> all_W = journey_.look();
    const std::vector<bool> is_exact = model_.exactRays(pose, all_W, window);
    for (std::size_t i = 0; i < all_W.size(); ++i) {
      all.points.push_back((pose.T_W_S.inverse() * all_W[i]).cast<float>());
      if (!is_exact[i]) continue;
      exact.points.push_back(all.points.back());
      points_W.push_back(all_W[i]);
    }
    const ScanReport report = small_.integrate(exact, pose);
    model_.integrate(pose, points_W, window);
    checkDecay();
    if (report.lower != model_.lowered() || report.raise != model_.raised()) {
      fail("other changes than the model's");
    }
    large_.integrate(all, pose);
    changes_ += report.changeScore();
    if (chance(random_, 0.02)) verifySmall();
    if (chance(random_, 0.005)) verifyLarge();
  }

  void checkDecay() {
    const auto in_time = model_.decay(small_.grid());
    if (!in_time) fail(in_time.message());
  }

  void reset() {
    small_.reset();
    model_.reset();
    large_.reset();
    ++resets_;
  }

  /// Radius and shape, and every voxel's log-odds.
  void reconfigure() {
    constexpr int kMostRadiusMm = 1000;
    element_ = {static_cast<ElementShape>(uniformInt(random_, 0, 2)),
                uniformInt(random_, 0, kMostRadiusMm), kResolutionMm};
    MapperConfig small = small_.config(), large = large_.config();
    small.inflation_radius = element_.radius();
    large.inflation_radius = uniformReal(random_, 0.0, 0.5);
    small.max_ray_length = uniformReal(random_, 1.0, 4.0);
    for (MapperConfig* config : {&small, &large}) {
      config->inflation_shape = element_.shape;
      config->p_hit = uniformReal(random_, 0.55, 0.9);
      config->p_max = uniformReal(random_, 0.9, 0.99);
      config->p_occ = uniformReal(random_, 0.55, 0.85);
      config->decay_time = chance(random_, 0.5) ? uniformInt(random_, 10, 500) * kStampStep : 0.0;
    }
    small_.reconfigure(small);
    model_.reconfigure(small);
    large_.reconfigure(large);
  }

  void verifySmall() {
    const auto same = model_.equals(small_.grid(), element_);
    if (!same) fail(same.message());
    ++verified_;
  }

  void verifyLarge() {
    const std::int64_t differences = countInflationMismatches(*large_.snapshot());
    if (differences != 0) fail(std::to_string(differences) + " inflated voxels differ");
    ++inflations_;
  }

  void report() {
    verifySmall();
    verifyLarge();
    std::printf(
        "%8.2f km  %9lld scans  %6lld teleports  %5lld resets  %10lld changes  "
        "verified: %7lld maps, %6lld inflated layers  resident %.1f MB\n",
        journey_.kilometres(), scans_, static_cast<long long>(journey_.teleports()), resets_,
        changes_, verified_, inflations_, residentMb());
    std::fflush(stdout);
  }

  Random random_;
  ElementDefinition element_{ElementShape::kBall, 500, kResolutionMm};
  Journey journey_;
  Mapper small_;
  test::MapperModel model_;
  Mapper large_;
  double warm_mb_ = 0.0;
  long long scans_ = 0, resets_ = 0, changes_ = 0, verified_ = 0, inflations_ = 0;
};

}  // namespace
}  // namespace fiimap

int main(int argc, char** argv) {
  const double kilometres = argc > 1 ? std::atof(argv[1]) : 0.0;
  const unsigned seed = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1u;
  if (!(kilometres > 0.0)) {
    std::cerr << "usage: " << argv[0] << " KILOMETRES [SEED], kilometres > 0\n";
    return 2;
  }
  try {
    fiimap::Soak(seed).travel(kilometres);
  } catch (const std::exception& error) {
    std::cerr << "seed " << seed << ", " << error.what() << '\n';
    return 1;
  }
  std::cout << "zero differences\n";
  return 0;
}
