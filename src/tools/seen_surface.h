#pragma once

#include <array>
#include <map>

#include "exact_scene.h"
#include "fiimap/range_data.h"
#include "fiimap/voxel_lattice.h"

namespace fiimap {

/// Remembers which cells of the exact surface a sensor has seen, and in how many scans.
class SeenSurface {
 public:
  /// Edge of a cell, m.
  static constexpr double kCell = 0.05;
  /// What is nearer to something that comes, goes or moves is left out, m.
  static constexpr double kPassingMargin = 0.5;

  /// \param max_range surfaces farther from the sensor count as unseen, m.
  SeenSurface(const ExactScene& scene, double max_range) : scene_(&scene), max_range_(max_range) {}

  /// A ray with a return has seen what is there in its direction, wherever noise put the return.
  /// \param time of the scene, s.
  void add(const RangeData& scan, double time);

  /// Calls visit(centre of the cell, number of scans).
  template <typename Visitor>
  void forEach(Visitor&& visit) const {
    for (const auto& [key, cell] : cells_) {
      if (!cell.passing) visit(lattice_.centerOf({key[0], key[1], key[2]}), cell.scans);
    }
  }

 private:
  struct Cell {
    bool passing = false;
    int scans = 0;
    std::size_t last_scan = 0;
  };

  const ExactScene* scene_;
  double max_range_;
  VoxelLattice lattice_{kCell};
  std::size_t scan_ = 0;
  std::map<std::array<int, 3>, Cell> cells_;
};

}  // namespace fiimap
