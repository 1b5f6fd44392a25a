// What save_map writes, read back: the .bt and .pcd files hold the map's voxels and no others.
// Damaged files are read or refused.

#include <octomap/octomap.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include "../core/oracle.h"
#include "byte_source.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/map_files.h"
#include "temporary_input.h"

namespace fiimap::fuzz {
namespace {

using test::VoxelSet;

MapperConfig takeConfig(ByteSource* bytes) {
  constexpr double kResolutions[] = {0.01, 0.05, 0.1, 0.3, 1.0, 10.0};
  MapperConfig config;
  config.resolution = kResolutions[bytes->integer(0, 5)];
  config.map_size_x = bytes->integer(1, 16) * config.resolution;
  config.map_size_y = bytes->integer(1, 40) * config.resolution;
  config.map_size_z = bytes->integer(1, 70) * config.resolution;
  config.slide_distance = 0.0;
  config.min_ray_length = 0.0;
  config.max_ray_length = 500.0;
  config.ray_end_cut = 0.0;
  config.inflation_radius = bytes->integer(0, 3) * config.resolution;
  return config;
}

VoxelSet voxelsOf(const Snapshot& snapshot, Plane plane) {
  const auto list = snapshot.voxels(plane, snapshot.window());
  return VoxelSet(list.begin(), list.end());
}

void comparePcd(const Snapshot& snapshot, Plane plane, const std::string& file) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  require(pcl::io::loadPCDFile(file, cloud) == 0, "the .pcd cannot be read");
  VoxelSet read;
  for (const pcl::PointXYZ& point : cloud) {
    read.insert(snapshot.lattice().indexOf(Eigen::Vector3d(point.x, point.y, point.z)));
  }
  require(read == voxelsOf(snapshot, plane), "the .pcd holds other voxels");
  require(static_cast<std::int64_t>(cloud.size()) == snapshot.count(plane), "a point twice");
}

void compareOctomap(const Snapshot& snapshot, const std::string& file) {
  octomap::OcTree tree(snapshot.lattice().resolution());
  require(tree.readBinary(file), "the .bt cannot be read");
  tree.expand();
  VoxelSet known, occupied;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const VoxelIndex v = snapshot.lattice().indexOf({leaf.getX(), leaf.getY(), leaf.getZ()});
    known.insert(v);
    if (tree.isNodeOccupied(*leaf)) occupied.insert(v);
  }
  require(known == voxelsOf(snapshot, Plane::kKnown), "the .bt knows other voxels");
  require(occupied == voxelsOf(snapshot, Plane::kOccupied), "the .bt has other obstacles");
}

VoxelSet voxelsOf(const std::vector<VoxelBox>& boxes) {
  VoxelSet voxels;
  for (const VoxelBox& box : boxes) {
    test::forEachVoxel(box, [&](const VoxelIndex& v) { voxels.insert(v); });
  }
  return voxels;
}

/// As load_map reads them.
void compareSaved(const Snapshot& snapshot, const SavedMap& saved, bool has_free) {
  VoxelSet voxels = voxelsOf(saved.occupied);
  require(voxels == voxelsOf(snapshot, Plane::kOccupied), "other obstacles are read");
  if (!has_free) return;
  for (const VoxelIndex& v : voxelsOf(saved.free)) voxels.insert(v);
  require(voxels == voxelsOf(snapshot, Plane::kKnown), "other known voxels are read");
}

/// Changes some bytes of a file, or all from some place on, and reads it.
template <typename Read>
void readDamaged(ByteSource* bytes, const TemporaryInput& file, Read&& read) {
  std::ifstream stream(file.path(), std::ios::binary);
  std::string content(std::istreambuf_iterator<char>(stream), {});
  constexpr int kAnywhere = 65535;
  const auto place = [&] { return bytes->integer(0, kAnywhere) % content.size(); };
  for (int i = bytes->integer(0, 4); i > 0; --i) content[place()] = bytes->take<char>();
  if (bytes->flag()) {
    content.resize(place() + 1);
    constexpr std::size_t kMost = 1000;
    for (const std::uint8_t byte : bytes->bytes(kMost)) content += static_cast<char>(byte);
  }
  file.write(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
  try {
    read(file.path());
  } catch (const std::runtime_error&) {
    // With a sentence; whatever else is thrown ends the fuzzer.
  }
}

void scan(ByteSource* bytes, Mapper* mapper) {
  const double edge = mapper->config().resolution;
  const auto takeOffset = [&](int reach) { return bytes->integer(-reach, reach) * edge; };
  constexpr int kFar = 30000;  // near the end of an OctoMap
  const int reach = bytes->integer(0, 7) == 0 ? kFar : 100;
  ScanPose pose;
  pose.vehicle_W = {takeOffset(reach), takeOffset(reach), takeOffset(reach)};
  pose.vehicle_W.array() += edge / 2.0;
  pose.T_W_S.translation() = pose.vehicle_W;
  PointScan points;
  for (int i = bytes->integer(0, 40); i > 0; --i) {
    points.points.push_back(
        Eigen::Vector3d(takeOffset(8), takeOffset(20), takeOffset(35)).cast<float>());
  }
  for (int i = 0; i < 3; ++i) mapper->integrate(points, pose);
}

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fiimap;
  static const fuzz::TemporaryInput pcd("map.pcd"), bt("map.bt");
  fuzz::ByteSource bytes(data, size);
  Mapper mapper(fuzz::takeConfig(&bytes));
  for (int i = 0; i < 4 && !bytes.empty(); ++i) fuzz::scan(&bytes, &mapper);
  const auto snapshot = mapper.snapshot();
  for (const Plane plane : {Plane::kOccupied, Plane::kInflated}) {
    if (snapshot->count(plane) == 0) continue;  // save_map refuses
    writePcd(*snapshot, plane, pcd.path());
    fuzz::comparePcd(*snapshot, plane, pcd.path());
    if (plane == Plane::kOccupied) fuzz::compareSaved(*snapshot, readPcd(pcd.path()), false);
    fuzz::readDamaged(&bytes, pcd, readPcd);
  }
  writeOctomap(*snapshot, bt.path());
  fuzz::compareOctomap(*snapshot, bt.path());
  fuzz::compareSaved(*snapshot, readOctomap(bt.path()), true);
  fuzz::readDamaged(&bytes, bt, readOctomap);
  return 0;
}
