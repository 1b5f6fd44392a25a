#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <stdexcept>

#include "fiimap/ros/map_files.h"

namespace fiimap {

void writePcd(const Snapshot& snapshot, Plane plane, const std::string& file) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (const VoxelIndex& v : snapshot.voxels(plane, snapshot.window())) {
    const Eigen::Vector3f center = snapshot.lattice().centerOf(v).cast<float>();
    cloud.push_back(pcl::PointXYZ(center.x(), center.y(), center.z()));
  }
  // PCL throws for some errors and returns a code for others.
  if (pcl::PCDWriter().writeBinary(file, cloud) != 0) throw std::runtime_error("cannot be written");
}

}  // namespace fiimap
