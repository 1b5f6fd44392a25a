#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdlib>
#include <map>
#include <string>

#include "complete_file.h"
#include "fiimap/ros/map_files.h"
#include "saved_map_file.h"

namespace fiimap {
namespace {

const char* const kResolutionKey = "# resolution ";  // a comment to other readers

/// Entries of a PCD header, by their first word.
std::map<std::string, std::string> readPcdHeader(SavedMapFile* file) {
  std::map<std::string, std::string> entries;
  for (std::string line = file->line();; line = file->line()) {
    const bool is_ours = line.rfind(kResolutionKey, 0) == 0;
    if (line.empty() || (line.front() == '#' && !is_ours)) continue;
    const std::size_t key_end = line.find(' ', is_ours ? 2 : 0);
    const std::string key = line.substr(0, key_end);
    entries[key] = key_end == std::string::npos ? "" : line.substr(key_end + 1);
    if (key == "DATA") return entries;
  }
}

}  // namespace

// PCL's own writer maps the file into memory, where a full disk may end the process; its header is
// followed by the coordinates of point after point.
void writePcd(const Snapshot& snapshot, Plane plane, const std::string& file) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (const VoxelIndex& v : snapshot.voxels(plane, snapshot.window())) {
    const Eigen::Vector3f center = snapshot.lattice().centerOf(v).cast<float>();
    cloud.push_back(pcl::PointXYZ(center.x(), center.y(), center.z()));
  }
  writeCompleteFile(file, [&](std::ostream& stream) {
    stream << pcl::PCDWriter::generateHeader(cloud) << kResolutionKey
           << snapshot.lattice().resolution() << "\nDATA binary\n";
    for (const pcl::PointXYZ& point : cloud) {
      stream.write(reinterpret_cast<const char*>(point.data), 3 * sizeof(float));
    }
  });
}

// PCL's own reader takes memory for as many points as a damaged header claims.
SavedMap readPcd(const std::string& path) {
  SavedMapFile file(path);
  std::map<std::string, std::string> header = readPcdHeader(&file);
  for (const auto& [key, value] : std::map<std::string, std::string>{{"FIELDS", "x y z"},
                                                                     {"SIZE", "4 4 4"},
                                                                     {"TYPE", "F F F"},
                                                                     {"COUNT", "1 1 1"},
                                                                     {"DATA", "binary"}}) {
    if (header[key] == value) continue;
    file.fail("is no PCD file of ~save_map: " + key + " is '" + header[key] + "', not '" + value +
              "'");
  }
  SavedMap map;
  map.resolution = std::strtod(header["# resolution"].c_str(), nullptr);
  if (!(map.resolution > 0.0)) file.fail("does not say its resolution: it is none of ~save_map");
  const VoxelLattice lattice(map.resolution);
  constexpr double kOffCenter = 0.25;  // voxels; single precision is worse too far away
  for (long left = std::strtol(header["POINTS"].c_str(), nullptr, 10); left > 0; --left) {
    Eigen::Vector3d point_W;
    for (int axis = 0; axis < 3; ++axis) point_W[axis] = file.take<float>();
    if (!lattice.canIndex(point_W)) file.fail("is damaged: a point is not finite or too far away");
    const VoxelIndex v = lattice.indexOf(point_W);
    if (lattice.toVoxels(point_W - lattice.centerOf(v)).cwiseAbs().maxCoeff() > kOffCenter) {
      file.fail("is damaged: a point is not the centre of a voxel of " + header["# resolution"] +
                " m");
    }
    map.occupied.push_back({v, v + VoxelIndex::Ones()});
  }
  file.requireEnd();
  return map;
}

}  // namespace fiimap
