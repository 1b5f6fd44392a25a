// Prints what the OctoMap library reads from a .bt file: the edge length, the number of free voxels
// and the centre of each occupied voxel.

#include <cstdio>

#include <octomap/octomap.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  octomap::OcTree tree(1.0);
  if (!tree.readBinary(argv[1])) return 1;
  tree.expand();
  long free_voxels = 0;
  std::printf("resolution %.9g\n", tree.getResolution());
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (tree.isNodeOccupied(*leaf)) {
      std::printf("occupied %.9g %.9g %.9g\n", leaf.getX(), leaf.getY(), leaf.getZ());
    } else {
      ++free_voxels;
    }
  }
  std::printf("free %ld\n", free_voxels);
  return 0;
}
