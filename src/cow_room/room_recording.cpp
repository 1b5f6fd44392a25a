#include "room_recording.h"

#include <geometry_msgs/TransformStamped.h>
#include <rosbag/bag.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "cow_room.h"
#include "kinect.h"
#include "ray_scene.h"

namespace fiimap {
namespace {

constexpr char kCloudTopic[] = "/camera/depth_registered/points";
constexpr char kTransformTopic[] = "/kinect/vrpn_client/estimated_transform";
constexpr std::int64_t kTransformPeriod_ns = 10'000'000;
constexpr std::int64_t kTransformDelay_ns = 4'000'000;  // from stamp to recording
constexpr std::int64_t kAfterLast_ns = 50'000'000;      // poses after the last scan
constexpr double kFarthestClearance = 5.0;              // m, where the search ends
constexpr int kMostPixelStep = 16;
constexpr double kNanosecondsPerSecond = 1e9;

ros::Time toTime(std::int64_t ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(ns));
  return time;
}

rosbag::CompressionType compressionOf(const std::string& name) {
  if (name == "lz4") return rosbag::compression::LZ4;
  if (name == "bz2") return rosbag::compression::BZ2;
  if (name == "none") return rosbag::compression::Uncompressed;
  throw std::invalid_argument("--compression " + name + ": must be lz4, bz2 or none");
}

/// A bag that is deleted unless it was finished.
class NewBag {
 public:
  NewBag(const std::string& file, const std::string& compression)
      : file_(file), partial_(file + ".partial") {
    bag_.setCompression(compressionOf(compression));
    bag_.open(partial_, rosbag::bagmode::Write);
  }
  ~NewBag() {
    if (!finished_) std::remove(partial_.c_str());
  }
  NewBag(const NewBag&) = delete;
  NewBag& operator=(const NewBag&) = delete;

  template <typename Message>
  void write(const std::string& topic, std::int64_t recorded_ns, const Message& message) {
    bag_.write(topic, toTime(recorded_ns), message);
  }

  void finish() {
    bag_.close();
    if (std::rename(partial_.c_str(), file_.c_str()) != 0) {
      throw std::runtime_error("cannot write " + file_);
    }
    finished_ = true;
  }

 private:
  std::string file_, partial_;
  bool finished_ = false;
  rosbag::Bag bag_;
};

/// The transforms of the marker body, written in the order of their recording.
class TransformWriter {
 public:
  TransformWriter(const std::vector<RecordedScan>& scans, NewBag* bag)
      : scans_(scans), bag_(bag), next_ns_(scans.front().stamp_ns) {}

  void writeUntil(std::int64_t recorded_ns) {
    for (; next_ns_ + kTransformDelay_ns <= recorded_ns; next_ns_ += kTransformPeriod_ns) {
      bag_->write(kTransformTopic, next_ns_ + kTransformDelay_ns, transformAt(next_ns_));
    }
  }

 private:
  geometry_msgs::TransformStamped transformAt(std::int64_t stamp_ns) const {
    const Eigen::Isometry3d T_W_V = poseAt(scans_, stamp_ns);
    const Eigen::Quaterniond q(T_W_V.linear());
    geometry_msgs::TransformStamped message;
    message.header.stamp = toTime(stamp_ns);
    message.header.frame_id = "vicon";
    message.child_frame_id = "kinect";
    message.transform.translation.x = T_W_V.translation().x();
    message.transform.translation.y = T_W_V.translation().y();
    message.transform.translation.z = T_W_V.translation().z();
    message.transform.rotation.x = q.x();
    message.transform.rotation.y = q.y();
    message.transform.rotation.z = q.z();
    message.transform.rotation.w = q.w();
    return message;
  }

  const std::vector<RecordedScan>& scans_;
  NewBag* bag_;
  std::int64_t next_ns_;
};

std::size_t invalidPoints(const sensor_msgs::PointCloud2& cloud) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < cloud.data.size(); at += cloud.point_step) {
    float x;
    std::memcpy(&x, &cloud.data[at], sizeof(x));
    count += std::isnan(x) ? 1 : 0;
  }
  return count;
}

void check(const std::vector<RecordedScan>& scans, const RoomRecordingOptions& options) {
  if (scans.empty()) throw std::invalid_argument("there is no scan to render");
  if (options.pixel_step < 1 || options.pixel_step > kMostPixelStep) {
    throw std::invalid_argument("--pixel-step " + std::to_string(options.pixel_step) +
                                ": must be in [1, " + std::to_string(kMostPixelStep) + "]");
  }
}

}  // namespace

RoomRecordingFigures writeRoomRecording(const std::vector<RecordedScan>& scans,
                                        const RoomRecordingOptions& options,
                                        const std::string& file,
                                        const std::function<void(std::size_t)>& progress) {
  check(scans, options);
  NewBag bag(file, options.compression);
  const sim::RayScene room(makeCowRoom());
  Kinect kinect(options.seed);
  TransformWriter transforms(scans, &bag);
  RoomRecordingFigures figures;
  figures.least_clearance = kFarthestClearance;
  std::size_t points = 0, invalid = 0;
  for (const RecordedScan& scan : scans) {
    const Eigen::Isometry3d T_W_C = scan.T_W_V * Kinect::T_V_C();
    sensor_msgs::PointCloud2 cloud = kinect.scan(room, T_W_C, figures.scans, options.pixel_step);
    cloud.header.stamp = toTime(scan.stamp_ns);
    cloud.header.frame_id = "camera_rgb_optical_frame";
    transforms.writeUntil(scan.recorded_ns);
    bag.write(kCloudTopic, scan.recorded_ns, cloud);
    figures.least_clearance = std::min(
        figures.least_clearance, room.distance(T_W_C.translation(), 0.0, figures.least_clearance));
    points += static_cast<std::size_t>(cloud.width) * cloud.height;
    invalid += invalidPoints(cloud);
    progress(++figures.scans);
  }
  transforms.writeUntil(scans.back().recorded_ns + kAfterLast_ns);
  bag.finish();
  figures.duration =
      static_cast<double>(scans.back().stamp_ns - scans.front().stamp_ns) / kNanosecondsPerSecond;
  figures.invalid_share = static_cast<double>(invalid) / static_cast<double>(points);
  return figures;
}

}  // namespace fiimap
