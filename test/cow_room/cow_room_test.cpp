// The rendered bag must be what the recording is: topics, layout, times, sensor; and a map of it,
// made with the recording's configuration, must be the map of the room.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "cow_room.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/scan_decoder.h"
#include "health/topic_health.h"
#include "kinect.h"
#include "ray_scene.h"
#include "room_recording.h"
#include "scan_evaluator.h"
#include "temporary_file.h"

namespace fiimap {
namespace {

constexpr char kClouds[] = "/camera/depth_registered/points";
constexpr char kTransforms[] = "/kinect/vrpn_client/estimated_transform";
constexpr double kStart = 1473521338.63;  // s
constexpr int kScans = 8;
constexpr double kPeriod = 0.036, kDelay = 0.15;  // s

/// Looks along the horizon from where the recorded camera passed, and turns.
Eigen::Isometry3d cameraPose(int scan) {
  Eigen::Matrix3d R_W_C;  // looks along x
  R_W_C << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T_W_C = Eigen::Isometry3d::Identity();
  T_W_C.linear() = Eigen::AngleAxisd(0.2 - 0.05 * scan, Eigen::Vector3d::UnitZ()) * R_W_C;
  T_W_C.translation() = Eigen::Vector3d(-1.16 + 0.01 * scan, 1.07, 1.14);
  return T_W_C;
}

/// A trajectory in the form of the file.
std::string trajectoryText() {
  std::ostringstream text;
  text << std::fixed << "# stamp tx ty tz qx qy qz qw recorded number\n";
  for (int i = 0; i < kScans; ++i) {
    const Eigen::Isometry3d T_W_V = cameraPose(i) * Kinect::T_V_C().inverse();
    const Eigen::Vector3d t = T_W_V.translation();
    const Eigen::Quaterniond q(T_W_V.linear());
    const double stamp = kStart + i * kPeriod;
    text << stamp << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y()
         << ' ' << q.z() << ' ' << q.w() << ' ' << stamp + kDelay << ' ' << i << '\n';
  }
  return text.str();
}

std::vector<RecordedScan> read(const std::string& text) {
  const TemporaryFile file(text);
  return readTrajectory(file.path());
}

TEST(RecordedTrajectoryTest, ReadsTimesAndPoses) {
  const std::vector<RecordedScan> scans = read(trajectoryText());
  ASSERT_EQ(scans.size(), static_cast<std::size_t>(kScans));
  EXPECT_EQ(scans[1].stamp_ns, 1473521338666000000);
  EXPECT_EQ(scans[1].recorded_ns, 1473521338816000000);
  const Eigen::Isometry3d T_W_C = scans[3].T_W_V * Kinect::T_V_C();
  EXPECT_TRUE(T_W_C.matrix().isApprox(cameraPose(3).matrix(), 1e-5));
}

TEST(RecordedTrajectoryTest, InterpolatesBetweenScansOnly) {
  std::vector<RecordedScan> scans(2);
  scans[0].stamp_ns = 1000;
  scans[1].stamp_ns = 2000;
  scans[1].T_W_V.translation().x() = 4.0;
  scans[1].T_W_V.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const auto& [stamp_ns, share] :
       {std::pair(0, 0.0), std::pair(1000, 0.0), std::pair(1250, 0.25), std::pair(9000, 1.0)}) {
    const Eigen::Isometry3d T_W_V = poseAt(scans, stamp_ns);
    EXPECT_NEAR(T_W_V.translation().x(), 4.0 * share, 1e-9) << stamp_ns;
    EXPECT_NEAR(Eigen::AngleAxisd(T_W_V.linear()).angle(), share, 1e-6) << stamp_ns;
  }
}

TEST(RecordedTrajectoryTest, SaysWhatIsWrongAndWhere) {
  const std::string good = "1.0 0 0 0 0 0 0 1 1.1\n";
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(good + "2.0 0 0 0 0 0 0 1\n").find("line 2: must be"), std::string::npos);
  EXPECT_NE(refusal(good + "2.0 0 0 0 0 0 0 0 2.1\n").find("line 2: must be"), std::string::npos);
  EXPECT_NE(refusal(good + "1.0 0 0 0 0 0 0 1 1.2\n").find("ascend"), std::string::npos);
  EXPECT_NE(refusal("1.0 0 0 0 0 0 0 1 0.9\n").find("before its stamp"), std::string::npos);
  EXPECT_NE(refusal("# nothing\n").find("no scan"), std::string::npos);
  EXPECT_THROW(readTrajectory("/does/not/exist"), std::invalid_argument);
}

/// A map of a bag, as `fiimap_eval run` builds it.
class RoomMap : public ScanEvaluator {
 public:
  explicit RoomMap(const EvaluationInput& input) : mapper_(input.mapper()) { play(input); }
  std::shared_ptr<const Snapshot> snapshot() { return mapper_.snapshot(); }

 private:
  void addScan(const SynchronizedScan& scan, std::size_t /*index*/) override {
    decoder_.integrate(scan, &mapper_);
  }
  void forget() override { mapper_.reset(); }

  Mapper mapper_;
  ScanDecoder decoder_;
};

class RoomRecordingTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { write(path(), RoomRecordingOptions()); }
  static void TearDownTestSuite() { unlink(path().c_str()); }

  static std::string path() { return testing::TempDir() + "cow_room_test.bag"; }

  static void write(const std::string& file, const RoomRecordingOptions& options) {
    figures_ = writeRoomRecording(read(trajectoryText()), options, file, [](std::size_t) {});
  }

  static std::string bytesOf(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  }

  static inline RoomRecordingFigures figures_;
};

TEST_F(RoomRecordingTest, HasTheTopicsTimesAndDelaysOfTheTrajectory) {
  rosbag::Bag bag(path(), rosbag::bagmode::Read);
  const TopicHealth clouds = healthOf(bag, kClouds), transforms = healthOf(bag, kTransforms);
  EXPECT_EQ(clouds.messages, static_cast<std::size_t>(kScans));
  EXPECT_EQ(clouds.type, "sensor_msgs/PointCloud2");
  EXPECT_NEAR(clouds.interval.median, kPeriod, 1e-6);
  EXPECT_NEAR(clouds.least_delay, kDelay, 1e-6);
  EXPECT_NEAR(clouds.delay.max, kDelay, 1e-6);
  EXPECT_EQ(transforms.type, "geometry_msgs/TransformStamped");
  EXPECT_NEAR(transforms.interval.max, 0.01, 1e-6);
  EXPECT_EQ(transforms.backward, 0u);
  EXPECT_GT(transforms.duration, kScans * kPeriod + kDelay);
}

TEST_F(RoomRecordingTest, CloudsLieInMemoryAsThoseOfTheRecordingDo) {
  rosbag::Bag bag(path(), rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery(kClouds));
  const auto cloud = view.begin()->instantiate<sensor_msgs::PointCloud2>();
  EXPECT_EQ(cloud->header.frame_id, "camera_rgb_optical_frame");
  EXPECT_EQ(cloud->width, 320u);
  EXPECT_EQ(cloud->height, 240u);
  EXPECT_EQ(cloud->point_step, 32u);
  EXPECT_EQ(cloud->row_step, 320u * 32u);
  EXPECT_FALSE(cloud->is_dense);
  ASSERT_EQ(cloud->fields.size(), 4u);
  EXPECT_EQ(cloud->fields[3].name, "rgb");
  EXPECT_EQ(cloud->fields[3].offset, 16u);

  constexpr double kRounding = 1.0 / 1024.0;  // m
  int valid = 0, index = 0;
  for (sensor_msgs::PointCloud2ConstIterator<float> p(*cloud, "x"); p != p.end(); ++p, ++index) {
    if (std::isnan(p[2])) continue;
    ++valid;
    const double u = 2.0 * (index % 320), v = 2.0 * (index / 320), z = p[2];
    ASSERT_NEAR(p[0], z * (u - 319.5) / 525.0, kRounding) << index;
    ASSERT_NEAR(p[1], z * (v - 239.5) / 525.0, kRounding) << index;
    ASSERT_NEAR(z * 1000.0, std::round(z * 1000.0), 1e-3) << index;
    ASSERT_GE(z, 0.45);
    ASSERT_LE(z, 8.5);
  }
  EXPECT_GT(valid, 320 * 240 / 2);
  EXPECT_LT(valid, 320 * 240);
}

/// Wrong intrinsics, extrinsics, poses or frames would put voxels where there is no surface.
TEST_F(RoomRecordingTest, ItsMapIsTheRoom) {
  InputOptions options;
  options.bag = path();
  options.config = FIIMAP_SOURCE_DIR "/config/cow_and_lady.yaml";
  options.settings = {"resolution=0.1", "p_hit=0.9", "pixel_step=1"};
  RoomMap map{EvaluationInput(options)};
  EXPECT_EQ(map.counters().integrated, static_cast<std::uint64_t>(kScans));

  const std::shared_ptr<const Snapshot> snapshot = map.snapshot();
  const sim::RayScene room(makeCowRoom());
  const double half_diagonal = std::sqrt(3.0) / 2.0 * 0.1;
  int occupied = 0, far = 0;
  for (const VoxelIndex& v : snapshot->voxels(Plane::kOccupied, snapshot->window())) {
    ++occupied;
    const Eigen::Vector3d center_W = snapshot->lattice().centerOf(v);
    far += room.distance(center_W, 0.0, 1.0) > half_diagonal ? 1 : 0;
  }
  EXPECT_GT(occupied, 500);
  EXPECT_LT(far, occupied / 10) << "of " << occupied;  // the steps of depth reach 8 cm at 5 m
}

TEST_F(RoomRecordingTest, CountsWhatItRendered) {
  EXPECT_EQ(figures_.scans, static_cast<std::size_t>(kScans));
  EXPECT_NEAR(figures_.duration, (kScans - 1) * kPeriod, 1e-6);
  const sim::RayScene room(makeCowRoom());
  double least = 5.0;
  for (int i = 0; i < kScans; ++i) {
    least = std::min(least, room.distance(cameraPose(i).translation(), 0.0, least));
  }
  EXPECT_NEAR(figures_.least_clearance, least, 1e-5);
  EXPECT_GT(figures_.invalid_share, 0.01);
  EXPECT_LT(figures_.invalid_share, 0.6);
}

TEST_F(RoomRecordingTest, IsTheSameEveryTimeAndAnotherWithAnotherSeed) {
  const std::string again = testing::TempDir() + "cow_room_again.bag";
  write(again, RoomRecordingOptions());
  EXPECT_TRUE(bytesOf(again) == bytesOf(path()));
  RoomRecordingOptions other_seed;
  other_seed.seed = 2;
  write(again, other_seed);
  EXPECT_FALSE(bytesOf(again) == bytesOf(path()));
  unlink(again.c_str());
}

TEST_F(RoomRecordingTest, LeavesNothingBehindWhenItFails) {
  const std::string file = testing::TempDir() + "cow_room_refused.bag";
  RoomRecordingOptions bad_step, bad_compression;
  bad_step.pixel_step = 0;
  bad_compression.compression = "zip";
  EXPECT_THROW(write(file, bad_step), std::invalid_argument);
  EXPECT_THROW(write(file, bad_compression), std::invalid_argument);
  const auto interrupt = [](std::size_t) { throw std::runtime_error("interrupted"); };
  EXPECT_THROW(writeRoomRecording(read(trajectoryText()), {}, file, interrupt), std::runtime_error);
  EXPECT_ANY_THROW(write("/does/not/exist/room.bag", {}));
  EXPECT_NE(access(file.c_str(), F_OK), 0);
  EXPECT_NE(access((file + ".partial").c_str(), F_OK), 0);
}

}  // namespace
}  // namespace fiimap
