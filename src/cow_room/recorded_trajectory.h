#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace fiimap {

/// When and where a scan of the Cow_and_Lady recording was taken. W: vicon, V: the marker body.
struct RecordedScan {
  std::int64_t stamp_ns = 0;
  std::int64_t recorded_ns = 0;  ///< when it was written to the bag
  Eigen::Isometry3d T_W_V = Eigen::Isometry3d::Identity();
};

/// Reads a line for each scan: stamp tx ty tz qx qy qz qw time-of-recording, s and m; more words
/// are not looked at, nor lines that begin with #. \return at least one scan, stamps and times of
/// recording ascending. \throws std::invalid_argument that names file and line.
std::vector<RecordedScan> readTrajectory(const std::string& file);

/// The pose at a time, between neighbouring scans: positions along the line, rotations along the
/// shortest arc. Before the first scan and after the last, theirs.
Eigen::Isometry3d poseAt(const std::vector<RecordedScan>& scans, std::int64_t stamp_ns);

}  // namespace fiimap
