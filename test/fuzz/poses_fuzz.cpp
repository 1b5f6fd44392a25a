// Poses, transforms, scans of one sensor or several, and clocks in any order, with any stamp, frame
// and number.

#include <algorithm>
#include <string>

#include <boost/make_shared.hpp>

#include "scan_feed.h"

namespace fiimap::fuzz {
namespace {

constexpr int kMostMessages = 64;

class Traffic {
 public:
  Traffic(const NodeConfig& config, ByteSource* bytes)
      : bytes_(*bytes), sensors_(config.allSensors().size()), feed_(mapOf(config), config) {}

  void send() {
    switch (bytes_.integer(0, 7)) {
      case 0:
        feed_.synchronizer().add(PoseMessage(odometry()));
        break;
      case 1:
        feed_.synchronizer().add(PoseMessage(poseStamped()));
        break;
      case 2:
      case 3:
        feed_.synchronizer().add(PoseMessage(transform()));
        break;
      case 4: {
        tf2_msgs::TFMessage transforms;
        for (int i = bytes_.integer(0, 3); i > 0; --i) transforms.transforms.push_back(transform());
        feed_.synchronizer().addTf(transforms, bytes_.flag());
        break;
      }
      case 5:
        feed_.synchronizer().expire({takeStamp(), {}});
        break;
      case 6:
        if (bytes_.integer(0, 15) == 0) feed_.synchronizer().restart("the clock went back");
        break;
      default: {
        const ScanMessage scan = cloud();  // before the sensor, whatever the compiler
        feed_.add(scan, bytes_.integer(0, sensors_ - 1));
      }
    }
    const ScanCounters& counters = feed_.counters();
    require(counters.received == counters.integrated + counters.dropped() + waiting(),
            "a scan is lost");
  }

  void finish() { feed_.finish(); }

 private:
  static MapperConfig mapOf(const NodeConfig& node) {
    MapperConfig config = smallMap();
    config.sensors.assign(node.sensors.size(), config);
    return config;
  }

  /// Scans of all sensors that wait.
  std::size_t waiting() {
    std::size_t scans = 0;
    for (int i = 0; i < sensors_; ++i) scans += feed_.synchronizer().waiting(i);
    return scans;
  }

  ros::Time takeStamp() {
    constexpr std::uint32_t kStart = 1600000000;  // s
    switch (bytes_.integer(0, 15)) {
      case 0:
        return ros::Time();
      case 1:
        return {bytes_.take<std::uint32_t>(), bytes_.take<std::uint32_t>() % 1000000000};
      default:
        now_ms_ +=
            bytes_.integer(0, 15) == 0 ? bytes_.integer(-30000, 30000) : bytes_.integer(-20, 200);
        now_ms_ = std::max(now_ms_, 0);
        return {kStart + static_cast<std::uint32_t>(now_ms_ / 1000),
                static_cast<std::uint32_t>(now_ms_ % 1000) * 1000000};
    }
  }

  std_msgs::Header takeHeader() {
    std_msgs::Header header;
    header.stamp = takeStamp();
    header.frame_id = takeFrame("world");
    return header;
  }

  std::string takeFrame(const std::string& usual) {
    const char* const known[] = {"world", "body", "camera", "/world", "", "/"};
    const int choice = bytes_.integer(0, 15);
    return choice < 6 ? known[choice] : choice == 6 ? bytes_.text(6) : usual;
  }

  geometry_msgs::Transform takeTransform() {
    geometry_msgs::Transform transform;
    transform.translation.x = bytes_.anyDouble(-2.0, 2.0);
    transform.translation.y = bytes_.anyDouble(-2.0, 2.0);
    transform.translation.z = bytes_.anyDouble(-2.0, 2.0);
    transform.rotation.w = 1.0;
    if (bytes_.integer(0, 7) == 0) {
      transform.rotation.x = bytes_.anyDouble(-1.0, 1.0);
      transform.rotation.y = bytes_.anyDouble(-1.0, 1.0);
      transform.rotation.z = bytes_.anyDouble(-1.0, 1.0);
      transform.rotation.w = bytes_.anyDouble(-1.0, 1.0);
    }
    return transform;
  }

  geometry_msgs::TransformStamped transform() {
    geometry_msgs::TransformStamped stamped;
    stamped.header = takeHeader();
    stamped.child_frame_id = takeFrame("body");
    stamped.transform = takeTransform();
    return stamped;
  }

  geometry_msgs::PoseStamped poseStamped() {
    geometry_msgs::PoseStamped stamped;
    const geometry_msgs::Transform transform = takeTransform();
    stamped.header = takeHeader();
    stamped.pose.position.x = transform.translation.x;
    stamped.pose.position.y = transform.translation.y;
    stamped.pose.position.z = transform.translation.z;
    stamped.pose.orientation = transform.rotation;
    return stamped;
  }

  nav_msgs::Odometry odometry() {
    nav_msgs::Odometry odometry;
    const geometry_msgs::PoseStamped pose = poseStamped();
    odometry.header = pose.header;
    odometry.child_frame_id = takeFrame("body");
    odometry.pose.pose = pose.pose;
    return odometry;
  }

  /// Of one point ahead.
  ScanMessage cloud() {
    const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
    cloud->header.stamp = takeStamp();
    cloud->header.frame_id = takeFrame("camera");
    const char* const names[] = {"x", "y", "z"};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      sensor_msgs::PointField field;
      field.name = names[axis];
      field.offset = axis * sizeof(float);
      field.datatype = sensor_msgs::PointField::FLOAT32;
      field.count = 1;
      cloud->fields.push_back(field);
    }
    cloud->width = cloud->height = 1;
    cloud->point_step = cloud->row_step = 3 * sizeof(float);
    cloud->data.resize(cloud->row_step);
    const float ahead = 2.0f;
    std::memcpy(cloud->data.data(), &ahead, sizeof(ahead));
    return sensor_msgs::PointCloud2ConstPtr(cloud);
  }

  ByteSource& bytes_;
  int sensors_;
  ScanFeed feed_;
  int now_ms_ = 0;
};

NodeConfig takeNode(ByteSource* bytes) {
  NodeConfig config = nodeWithoutTf(SensorKind::kPoints);
  config.pose_source = static_cast<PoseSource>(bytes->integer(0, 3));
  config.extrinsics = static_cast<ExtrinsicsSource>(bytes->integer(0, 1));
  config.time_offset = bytes->anyDouble(-1.0, 1.0);
  config.max_pose_wait = bytes->real(0.0, 1.0);
  config.max_pose_gap = bytes->real(0.001, 1.0);
  config.pose_history = bytes->real(1.0, 5.0);
  config.scan_queue_size = bytes->integer(1, 5);
  if (bytes->flag()) config.body_frame = "body";
  constexpr int kMostSensors = 3;
  for (int i = std::max(bytes->integer(-2, kMostSensors), 0); i > 0; --i) {
    SensorConfig sensor = config;
    sensor.name = "sensor_" + std::to_string(i);
    sensor.extrinsics = static_cast<ExtrinsicsSource>(bytes->integer(0, 1));
    sensor.time_offset = bytes->anyDouble(-1.0, 1.0);
    config.sensors.push_back(sensor);
  }
  return config;
}

bool isValid(const NodeConfig& config) {
  try {
    config.validate();
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fiimap::fuzz;
  ByteSource bytes(data, size);
  const fiimap::NodeConfig config = takeNode(&bytes);
  if (!isValid(config)) return 0;
  Traffic traffic(config, &bytes);
  for (int i = 0; i < kMostMessages && !bytes.empty(); ++i) traffic.send();
  traffic.finish();
  return 0;
}
