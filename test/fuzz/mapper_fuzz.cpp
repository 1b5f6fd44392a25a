// The whole map under any sequence of operations, against the model of the property tests.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "../core/mapper_model.h"
#include "byte_source.h"

namespace fiimap::fuzz {
namespace {

using test::ElementDefinition;
using test::MapperModel;

constexpr int kResolutionMm = 250;
constexpr int kMostOperations = 24;
constexpr double kStampStep = 1e-9;  // s

ElementDefinition takeElement(ByteSource* bytes) {
  constexpr int kMostRadiusMm = 1500;  // larger than most of the windows below
  const auto shape = static_cast<ElementShape>(bytes->integer(0, 2));
  return {shape, bytes->integer(0, kMostRadiusMm), kResolutionMm};
}

void takeTunable(MapperConfig* config, ByteSource* bytes) {
  const auto voxels = [&](int most) { return bytes->integer(1, most) * config->resolution; };
  config->local_update_range_x = voxels(12);
  config->local_update_range_y = voxels(14);
  config->local_update_range_z = voxels(70);
  config->slide_distance = bytes->real(0.0, config->mapSize().minCoeff() / 2.0);
  config->ray_end_cut = bytes->integer(0, 4) * 0.5;
  config->round_rays = bytes->integer(0, 3) != 0;
  config->max_ray_length = bytes->real(0.5, 10.0);
  config->p_hit = bytes->real(0.55, 0.95);
  config->p_miss = bytes->real(0.13, 0.45);
  config->p_occ = bytes->real(0.55, 0.9);
  config->inflation_method = static_cast<InflationMethod>(bytes->integer(0, 2));
  config->bfs_connectivity = bytes->flag() ? 6 : bytes->flag() ? 18 : 26;
  config->beyond_max_depth = bytes->flag() ? ReadingPolicy::kIgnore : ReadingPolicy::kFree;
  config->decay_time = std::max(bytes->integer(-20, 20), 0) * kStampStep;
}

MapperConfig takeConfig(const ElementDefinition& element, ByteSource* bytes) {
  MapperConfig config;
  config.resolution = element.resolution();
  const auto voxels = [&](int most) { return bytes->integer(1, most) * config.resolution; };
  config.map_size_x = voxels(12);
  config.map_size_y = voxels(40);
  config.map_size_z = voxels(12);
  config.min_hit_cover = 0.0;  // the model has no cover
  config.min_depth = config.min_ray_length = 0.1;
  config.max_depth = 100.0;
  config.pixel_step = 1;
  config.border_margin = 0;
  config.inflation_radius = element.radius();
  config.inflation_shape = element.shape;
  config.map_mode = bytes->integer(0, 7) == 0 ? MapMode::kFixed : MapMode::kSliding;
  takeTunable(&config, bytes);
  return config;
}

/// A map, its model, and snapshots of what it was.
class Session {
 public:
  explicit Session(ByteSource* bytes)
      : bytes_(*bytes),
        element_(takeElement(bytes)),
        config_(takeConfig(element_, bytes)),
        mapper_(config_),
        model_(config_) {}

  void operate() {
    switch (bytes_.integer(0, 9)) {
      case 0:
        mapper_.reset();
        model_.reset();
        break;
      case 1:
        reconfigure();
        break;
      case 2:
        keepSnapshot();
        break;
      case 3:
        offerABadPose();
        break;
      case 4:
        position_ =
            Eigen::Vector3d(bytes_.real(-1e6, 1e6), bytes_.real(-1e6, 1e6), bytes_.real(-1e4, 1e4));
        break;
      case 5:
        seeImage();
        break;
      default:
        seePoints();
    }
    const auto same = model_.equals(mapper_.grid(), element_);
    require(static_cast<bool>(same), same.message());
  }

  void checkSnapshots() const {
    for (const Kept& kept : kept_) {
      for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
        const auto& then = kept.voxels[static_cast<int>(plane)];
        require(kept.snapshot->voxels(plane, kept.snapshot->window()) == then,
                "a snapshot changed");
      }
    }
  }

 private:
  struct Kept {
    std::shared_ptr<const Snapshot> snapshot;
    std::vector<VoxelIndex> voxels[kPlaneCount];
  };

  /// Anything that may change; the window stays.
  void reconfigure() {
    element_ = takeElement(&bytes_);
    MapperConfig config = mapper_.config();
    config.inflation_radius = element_.radius();
    config.inflation_shape = element_.shape;
    takeTunable(&config, &bytes_);
    mapper_.reconfigure(config);
    model_.reconfigure(config);
  }

  void keepSnapshot() {
    Kept kept;
    kept.snapshot = mapper_.snapshot();
    const VoxelBox& window = kept.snapshot->window();
    require(window == mapper_.grid().window(), "the snapshot has another window");
    for (const Plane plane : {Plane::kKnown, Plane::kOccupied, Plane::kInflated}) {
      kept.voxels[static_cast<int>(plane)] = kept.snapshot->voxels(plane, window);
      require(kept.snapshot->count(plane) == mapper_.grid().count(plane),
              "the snapshot has another count");
    }
    kept_.push_back(kept);
  }

  void offerABadPose() {
    ScanPose pose = takePose();
    constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity(), -1e300, 1e9};
    const double bad = kBad[bytes_.integer(0, 3)];
    const int axis = bytes_.integer(0, 2);
    (bytes_.flag() ? pose.vehicle_W[axis] : pose.T_W_S.translation()[axis]) = bad;
    try {
      mapper_.integrate(PointScan{{{1.0f, 0.0f, 0.0f}}}, pose);
      require(false, "a bad pose was integrated");
    } catch (const std::invalid_argument&) {
    }
  }

  ScanPose takePose() {
    const double reach = bytes_.flag() ? 5.0 : 0.3;
    position_ += Eigen::Vector3d(bytes_.real(-reach, reach), bytes_.real(-reach, reach),
                                 bytes_.real(-reach, reach));
    ScanPose pose;
    pose.vehicle_W = position_;
    pose.T_W_S.translation() =
        position_ + Eigen::Vector3d(bytes_.real(-0.5, 0.5), 0.0, bytes_.real(-0.5, 0.5));
    const Eigen::Vector3d axis(bytes_.real(-1.0, 1.0), bytes_.real(-1.0, 1.0), 1.0);
    pose.T_W_S.linear() =
        Eigen::AngleAxisd(bytes_.real(-3.2, 3.2), axis.normalized()).toRotationMatrix();
    pose.stamp_ns = ++stamp_;
    return pose;
  }

  /// The window moves first, without a reading, because the model takes it from the map.
  ScanPose slide() {
    const ScanPose pose = takePose();
    mapper_.integrate(PointScan(), pose);
    integrateInModel(pose, {});
    return pose;
  }

  void seePoints() {
    constexpr int kMostPoints = 12;
    const ScanPose pose = slide();
    std::vector<Eigen::Vector3d> points_S, all_W;
    for (int i = bytes_.integer(0, kMostPoints); i > 0; --i) {
      const double reach = bytes_.flag() ? 2.0 : 12.0;
      points_S.emplace_back(bytes_.real(-reach, reach), bytes_.real(-reach, reach),
                            bytes_.real(-reach, reach));
      all_W.push_back(pose.T_W_S * points_S.back());
    }
    const std::vector<bool> is_exact = model_.exactRays(pose, all_W, mapper_.grid().window());
    PointScan scan;
    std::vector<Eigen::Vector3d> points_W;
    for (std::size_t i = 0; i < all_W.size(); ++i) {
      if (!is_exact[i]) continue;
      scan.points.push_back(points_S[i].cast<float>());
      points_W.push_back(all_W[i]);
    }
    for (int times = bytes_.integer(1, 3); times > 0; --times) {
      const ScanReport report = mapper_.integrate(scan, pose);
      integrateInModel(pose, points_W);
      require(report.lower == model_.lowered() && report.raise == model_.raised(),
              "the report counts other changes than the model");
    }
  }

  void seeImage() {
    constexpr int kMostPixels = 5;
    const ScanPose pose = slide();
    const int width = bytes_.integer(1, kMostPixels), height = bytes_.integer(1, kMostPixels);
    const PinholeIntrinsics camera{bytes_.real(1.0, 9.0), bytes_.real(1.0, 9.0),
                                   bytes_.real(0.0, 5.0), bytes_.real(0.0, 5.0)};
    std::vector<float> pixels;
    std::vector<Eigen::Vector3d> all_W;
    for (int i = 0; i < width * height; ++i) {
      const auto depth = static_cast<float>(bytes_.real(0.2, 12.0));
      const Eigen::Vector3d point_C((i % width - camera.cx) / camera.fx * depth,
                                    (i / width - camera.cy) / camera.fy * depth, depth);
      pixels.push_back(depth);
      all_W.push_back(pose.T_W_S * point_C);
    }
    const std::vector<bool> is_exact = model_.exactRays(pose, all_W, mapper_.grid().window());
    std::vector<Eigen::Vector3d> points_W;
    for (std::size_t i = 0; i < all_W.size(); ++i) {
      if (is_exact[i]) {
        points_W.push_back(all_W[i]);
      } else {
        pixels[i] = 0.0f;
      }
    }
    mapper_.integrate(
        {pixels.data(), DepthImage::Format::kFloat32, width, height, width * sizeof(float)}, camera,
        pose);
    integrateInModel(pose, points_W);
  }

  void integrateInModel(const ScanPose& pose, const std::vector<Eigen::Vector3d>& points_W) {
    model_.integrate(pose, points_W, mapper_.grid().window());
    const auto in_time = model_.decay(mapper_.grid());
    require(static_cast<bool>(in_time), in_time.message());
  }

  ByteSource& bytes_;
  ElementDefinition element_;
  MapperConfig config_;
  Mapper mapper_;
  MapperModel model_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  std::int64_t stamp_ = 0;
  std::vector<Kept> kept_;
};

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fiimap::fuzz::ByteSource bytes(data, size);
  fiimap::fuzz::Session session(&bytes);
  for (int i = 0; i < fiimap::fuzz::kMostOperations && !bytes.empty(); ++i) session.operate();
  session.checkSnapshots();
  return 0;
}
