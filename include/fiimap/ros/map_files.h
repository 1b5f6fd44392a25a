#pragma once

#include <string>
#include <vector>

#include "fiimap/snapshot.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// Writes NAME_occupied.pcd, NAME_inflated.pcd (voxel centres, m, binary) and NAME.bt
/// (OctoMap of the raw layer, occupied and free). Each file is complete or as it was before.
///
/// \param directory must exist.
/// \param name letters, digits, '_', '-' and '.'.
/// \return what was written, in words.
/// \throws std::runtime_error that says what is wrong with directory or name, or which file could
/// not be written.
std::string saveMap(const Snapshot& snapshot, const std::string& directory,
                    const std::string& name);

/// A map as it was saved. Boxes do not overlap.
struct SavedMap {
  std::string file;                ///< that it was read from
  double resolution = 0.0;         ///< m
  std::vector<VoxelBox> occupied;  ///< in voxels of that size
  std::vector<VoxelBox> free;      ///< the same
};

/// Reads NAME.bt, or where there is no such file the obstacles of NAME_occupied.pcd.
/// \throws std::runtime_error that says what is wrong with directory, name or file; memory
/// is taken in proportion to the file's size, whatever it says.
SavedMap readMap(const std::string& directory, const std::string& name);

/// Writes the centres of the set voxels of a plane as a binary PCD file.
/// \throws std::runtime_error.
void writePcd(const Snapshot& snapshot, Plane plane, const std::string& file);
/// Reads obstacles from such a file.
/// \throws std::runtime_error, also for a PCD file of others: it does not say its resolution.
SavedMap readPcd(const std::string& file);

/// Writes occupied and free voxels as an OctoMap .bt file.
/// \throws std::runtime_error, also when the window lies beyond the reach of an OctoMap.
void writeOctomap(const Snapshot& snapshot, const std::string& file);
/// Reads an OctoMap .bt file, also one of others.
/// \throws std::runtime_error.
SavedMap readOctomap(const std::string& file);

}  // namespace fiimap
