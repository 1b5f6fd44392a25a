#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "complete_file.h"
#include "fiimap/ros/map_files.h"

namespace fiimap {

// PCL's own writer maps the file into memory, where a full disk may end the process; its header is
// followed by the coordinates of point after point.
void writePcd(const Snapshot& snapshot, Plane plane, const std::string& file) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (const VoxelIndex& v : snapshot.voxels(plane, snapshot.window())) {
    const Eigen::Vector3f center = snapshot.lattice().centerOf(v).cast<float>();
    cloud.push_back(pcl::PointXYZ(center.x(), center.y(), center.z()));
  }
  writeCompleteFile(file, [&cloud](std::ostream& stream) {
    stream << pcl::PCDWriter::generateHeader(cloud) << "DATA binary\n";
    for (const pcl::PointXYZ& point : cloud) {
      stream.write(reinterpret_cast<const char*>(point.data), 3 * sizeof(float));
    }
  });
}

}  // namespace fiimap
