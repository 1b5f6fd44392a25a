#include "fiimap/ros/map_messages.h"

#include <cstring>
#include <vector>

#include "fiimap/ros/geometry_messages.h"

namespace fiimap {
namespace {

static_assert(static_cast<int>(ElementShape::kBall) == MapInfo::SHAPE_BALL &&
                  static_cast<int>(ElementShape::kCube) == MapInfo::SHAPE_CUBE &&
                  static_cast<int>(ElementShape::kDiamond) == MapInfo::SHAPE_DIAMOND,
              "the message's constants must follow ElementShape");

constexpr std::uint32_t kPointBytes = 3 * sizeof(float);
constexpr double kLineWidth = 0.05;  // m
constexpr double kAxisLength = 1.0;  // m
constexpr double kAxisWidth = 0.15;  // m

void addField(const std::string& name, std::uint32_t offset, sensor_msgs::PointCloud2* cloud) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  cloud->fields.push_back(field);
}

}  // namespace

std_msgs::Header toHeader(std::int64_t stamp_ns, const std::string& map_frame) {
  std_msgs::Header header;
  header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  header.frame_id = map_frame;
  return header;
}

std_msgs::Header toHeader(const Snapshot& snapshot, const std::string& map_frame) {
  return toHeader(snapshot.info().stamp_ns, map_frame);
}

MapInfo toMapInfo(const Snapshot& snapshot, const std::string& id, const std::string& map_frame) {
  const Snapshot::Info& info = snapshot.info();
  MapInfo message;
  message.header = toHeader(snapshot, map_frame);
  message.id = id;
  message.sequence = info.sequence;
  message.resolution = info.resolution;
  for (int axis = 0; axis < 3; ++axis) {
    message.window_min[axis] = info.window.min[axis];
    message.window_max[axis] = info.window.max[axis];
  }
  message.inflation_radius = info.inflation_radius;
  message.inflation_shape = static_cast<std::uint8_t>(info.inflation_shape);
  return message;
}

sensor_msgs::PointCloud2 emptyCloud(const std_msgs::Header& header) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.height = 1;
  cloud.point_step = kPointBytes;
  cloud.is_dense = true;
  addField("x", 0, &cloud);
  addField("y", sizeof(float), &cloud);
  addField("z", 2 * sizeof(float), &cloud);
  return cloud;
}

sensor_msgs::PointCloud2 toPointCloud(const Snapshot& snapshot, Plane plane,
                                      const std::string& map_frame) {
  const std::vector<VoxelIndex> voxels = snapshot.voxels(plane, snapshot.window());
  sensor_msgs::PointCloud2 cloud = emptyCloud(toHeader(snapshot, map_frame));
  cloud.width = static_cast<std::uint32_t>(voxels.size());
  cloud.row_step = cloud.width * kPointBytes;
  cloud.data.resize(cloud.row_step);
  std::uint8_t* out = cloud.data.data();
  for (const VoxelIndex& v : voxels) {
    const Eigen::Vector3f center = snapshot.lattice().centerOf(v).cast<float>();
    std::memcpy(out, center.data(), kPointBytes);
    out += kPointBytes;
  }
  return cloud;
}

visualization_msgs::Marker toOutline(const VoxelBox& box, const Snapshot& snapshot,
                                     const std::string& map_frame, const std::string& name) {
  visualization_msgs::Marker marker;
  marker.header = toHeader(snapshot, map_frame);
  marker.ns = name;
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = kLineWidth;
  marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1.0F;
  const double resolution = snapshot.lattice().resolution();
  const Eigen::Vector3d corners[2] = {box.min.cast<double>() * resolution,
                                      box.max.cast<double>() * resolution};
  // An edge joins two corners, numbered by a bit per axis, that differ in one bit.
  const auto corner = [&corners](int bits) {
    return toPoint(
        {corners[bits & 1].x(), corners[(bits >> 1) & 1].y(), corners[(bits >> 2) & 1].z()});
  };
  for (int from = 0; from < 8; ++from) {
    for (int axis = 0; axis < 3; ++axis) {
      const int to = from | (1 << axis);
      if (to == from) continue;
      marker.points.push_back(corner(from));
      marker.points.push_back(corner(to));
    }
  }
  return marker;
}

geometry_msgs::PoseStamped toPose(const Eigen::Isometry3d& T_W_B, const std_msgs::Header& header) {
  const Eigen::Quaterniond rotation(T_W_B.linear());
  geometry_msgs::PoseStamped pose;
  pose.header = header;
  pose.pose.position = toPoint(T_W_B.translation());
  pose.pose.orientation.x = rotation.x();
  pose.pose.orientation.y = rotation.y();
  pose.pose.orientation.z = rotation.z();
  pose.pose.orientation.w = rotation.w();
  return pose;
}

nav_msgs::Path toPath(const VehiclePath& path, const std::string& map_frame) {
  nav_msgs::Path message;
  message.poses = path.poses();
  if (!message.poses.empty()) message.header = message.poses.back().header;
  message.header.frame_id = map_frame;
  return message;
}

visualization_msgs::Marker toVehicleMarker(const VehiclePath& path, const std::string& map_frame) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = map_frame;
  marker.ns = "vehicle";
  marker.action = visualization_msgs::Marker::DELETE;
  if (path.poses().empty()) return marker;
  marker.header = path.poses().back().header;
  marker.action = visualization_msgs::Marker::ADD;
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.pose = path.poses().back().pose;
  marker.scale.x = kAxisWidth;
  for (int axis = 0; axis < 3; ++axis) {
    std_msgs::ColorRGBA color;
    color.a = 1.0F;
    (axis == 0 ? color.r : axis == 1 ? color.g : color.b) = 1.0F;
    for (const double length : {0.0, kAxisLength}) {
      marker.points.push_back(toPoint(length * Eigen::Vector3d::Unit(axis)));
      marker.colors.push_back(color);
    }
  }
  return marker;
}

}  // namespace fiimap
