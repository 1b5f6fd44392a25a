// The map of the synthetic flight against the geometry that it was rendered from.

#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include <array>
#include <iostream>
#include <map>
#include <memory>

#include "bag_player.h"
#include "bag_topics.h"
#include "exact_scene.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/message_conversions.h"
#include "fiimap/ros/scan_decoder.h"
#include "reading_projector.h"
#include "seen_surface.h"
#include "truth_report.h"

namespace fiimap {
namespace {

const std::string kFlightBag = std::string(FIIMAP_SOURCE_DIR) + "/data/synth_flight_excerpt.bag";
const std::string kFlightScene = std::string(FIIMAP_SOURCE_DIR) + "/data/synth_flight_scene.json";

constexpr double kPassingReach = 6.0;   // m: a shape that moves stays this near where it began
constexpr double kPassingMargin = 0.5;  // m around what comes, goes or moves
constexpr int kReadingStep = 4;         // pixels
constexpr double kNanosecond = 1e-9;    // s

using CellKey = std::array<int, 3>;

CellKey keyOf(const VoxelIndex& v) { return {v.x(), v.y(), v.z()}; }

/// Builds the map with the shipped defaults and, beside it, remembers which cells of the exact
/// surface each image showed.
class SceneListener : public ScanListener {
 public:
  SceneListener(const MapperConfig& config, const ExactScene& scene)
      : mapper_(config),
        scene_(scene),
        surface_(scene, config.max_ray_length),
        projector_(config, kReadingStep) {}

  void onScan(const SynchronizedScan& scan) override {
    noteVoxelsSeenThrough(scan);
    decoder_.integrate(scan, &mapper_);
    time_ = scan.pose.stamp_ns * kNanosecond - scene_.startTime();
    noteSurface(scan);
  }
  void onDrop(const Drop& drop, std::size_t) override { FAIL() << drop.text(); }
  void onTimeJump(const std::string& what) override { FAIL() << what; }
  void onWarning(const std::string& text) override { FAIL() << text; }

  std::shared_ptr<const Snapshot> map() { return mapper_.snapshot(); }
  const SeenSurface& surface() const { return surface_; }
  double time() const { return time_; }
  /// How many images looked through each voxel that was occupied where a shape had been.
  const std::map<CellKey, int>& seenThrough() const { return seen_through_; }
  int missesToClear() const { return mapper_.logOdds().missesToClear(); }

 private:
  void noteVoxelsSeenThrough(const SynchronizedScan& scan) {
    const std::shared_ptr<const Snapshot> map = mapper_.snapshot();
    const DecodedDepthImage decoded =
        decodeDepthImage(std::get<sensor_msgs::ImageConstPtr>(scan.message));
    for (const ExactScene::Shape& shape : scene_.shapes()) {
      if (shape.alwaysThere()) continue;
      const double resolution = mapper_.config().resolution;
      const VoxelIndex reach = VoxelIndex::Constant(static_cast<int>(kPassingReach / resolution));
      const VoxelIndex middle = map->lattice().indexOf(shape.center);
      for (const VoxelIndex& v : map->voxels(Plane::kOccupied, {middle - reach, middle + reach})) {
        const Eigen::Vector3d center_W = map->lattice().centerOf(v);
        const bool was_there = shape.distanceWhileThere(center_W) < resolution;
        if (!was_there || scene_.signedDistance(center_W, time_) < resolution) continue;
        const Eigen::Vector3d center_C = scan.pose.T_W_S.inverse() * center_W;
        const double margin = (mapper_.config().ray_end_cut + 2.0) * resolution;
        if (center_C.z() > mapper_.config().min_depth &&
            depthAt(decoded.view, scan.intrinsics, center_C) > center_C.z() + margin) {
          ++seen_through_[keyOf(v)];
        }
      }
    }
  }

  /// Depth reading (m) in the direction of a point before the camera; 0 outside the image or where
  /// it is invalid.
  double depthAt(const DepthImage& image, const PinholeIntrinsics& k,
                 const Eigen::Vector3d& point_C) const {
    const double u = std::round(k.fx * point_C.x() / point_C.z() + k.cx);
    const double v = std::round(k.fy * point_C.y() / point_C.z() + k.cy);
    const int margin = mapper_.config().border_margin;
    if (u < margin || v < margin || u >= image.width - margin || v >= image.height - margin) {
      return 0.0;
    }
    const auto* row = reinterpret_cast<const std::uint16_t*>(
        static_cast<const char*>(image.data) + static_cast<std::size_t>(v) * image.row_bytes);
    return row[static_cast<std::size_t>(u)] * mapper_.config().depth_scale;
  }

  void noteSurface(const SynchronizedScan& scan) {
    RangeData range;
    projector_.project(scan, &range);
    surface_.add(range, time_);
  }

  Mapper mapper_;
  const ExactScene& scene_;
  ScanDecoder decoder_;
  SeenSurface surface_;
  ReadingProjector projector_;
  std::map<CellKey, int> seen_through_;
  double time_ = 0.0;
};

/// The map at the end of the flight.
struct FlownMap {
  FlownMap(double resolution, const ExactScene& scene) {
    MapperConfig config;
    config.resolution = resolution;
    listener = std::make_unique<SceneListener>(config, scene);
    rosbag::Bag bag(kFlightBag, rosbag::bagmode::Read);
    NodeConfig node;
    const BagTopics topics = chooseTopics(bag, {}, {}, &node);
    ScanCounters counters;
    BagPlayer(bag, topics, node).play(listener.get(), &counters);
    snapshot = listener->map();
  }

  std::unique_ptr<SceneListener> listener;
  std::shared_ptr<const Snapshot> snapshot;
};

/// All tests of a resolution look at one flight.
class ExactSceneTest : public testing::TestWithParam<double> {
 protected:
  static void SetUpTestSuite() { scene_ = new ExactScene(ExactScene::load(kFlightScene)); }
  static void TearDownTestSuite() {
    maps_.clear();
    delete scene_;
  }

  void SetUp() override {
    const double resolution = GetParam();
    if (maps_.count(resolution) == 0) maps_.try_emplace(resolution, resolution, *scene_);
    listener_ = maps_.at(resolution).listener.get();
    map_ = maps_.at(resolution).snapshot.get();
  }

  bool nearPassing(const Eigen::Vector3d& point_W) const {
    return scene_->distanceToPassing(point_W) < kPassingMargin;
  }

  static ExactScene* scene_;
  static std::map<double, FlownMap> maps_;  // by resolution, m
  const SceneListener* listener_ = nullptr;
  const Snapshot* map_ = nullptr;
};

ExactScene* ExactSceneTest::scene_ = nullptr;
std::map<double, FlownMap> ExactSceneTest::maps_;

TEST_P(ExactSceneTest, FindsSurfacesThatWereSeenOften) {
  TruthCount count;
  compareWithScene(*map_, *scene_, listener_->surface(), map_->window(), listener_->time(), &count);
  std::cout << "resolution " << GetParam() << " m: " << 100.0 * count.recallOften() << " % of "
            << count.often << " surface cells seen in at least " << TruthCount::kOften
            << " images are found\n";
  ASSERT_GT(count.often, 1000u);
  EXPECT_GE(count.recallOften(), 0.995);
}

TEST_P(ExactSceneTest, PutsObstaclesOnSurfaces) {
  std::size_t obstacles = 0, far = 0, half = 0;
  const double half_diagonal = GetParam() * std::sqrt(3.0) / 2.0;
  for (const VoxelIndex& v : map_->voxels(Plane::kOccupied, map_->window())) {
    const Eigen::Vector3d center_W = map_->lattice().centerOf(v);
    if (nearPassing(center_W)) continue;
    ++obstacles;
    const double distance = std::abs(scene_->signedDistance(center_W, listener_->time()));
    if (distance > GetParam()) ++far;
    if (distance > half_diagonal) ++half;
  }
  const double share = static_cast<double>(far) / obstacles;
  std::cout << "resolution " << GetParam() << " m: of " << obstacles << " occupied voxels "
            << 100.0 * share << " % are farther than a voxel from any surface, "
            << 100.0 * half / obstacles << " % farther than half a diagonal\n";
  ASSERT_GT(obstacles, 1000u);
  // Readings are quantised to 0.2 m at the far end of their range: new walls stand a voxel too
  // near.
  EXPECT_LE(share, GetParam() > 0.15 ? 0.06 : 0.03);
}

TEST_P(ExactSceneTest, ClearsWhatMovedAway) {
  std::size_t cleared = 0, left = 0;
  for (const auto& [key, images] : listener_->seenThrough()) {
    if (map_->occupancy(VoxelIndex(key[0], key[1], key[2])) != Occupancy::kOccupied) {
      ++cleared;
    } else if (images > listener_->missesToClear()) {
      ++left;
    }
  }
  std::cout << "resolution " << GetParam()
            << " m: where obstacles had been and images looked through, " << cleared
            << " voxels are cleared; " << left << " are left after more than "
            << listener_->missesToClear() << " such images\n";
  ASSERT_GT(cleared, 0u);
  EXPECT_EQ(left, 0u);
}

INSTANTIATE_TEST_SUITE_P(Resolutions, ExactSceneTest, testing::Values(0.2, 0.1));

}  // namespace
}  // namespace fiimap
