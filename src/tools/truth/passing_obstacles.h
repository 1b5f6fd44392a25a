#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "exact_scene.h"
#include "fiimap/range_data.h"
#include "fiimap/snapshot.h"
#include "truth/passed_voxels.h"

namespace fiimap {

/// How fast a map takes in obstacles that come, and lets go of those that have gone.
class PassingObstacles {
 public:
  /// \param scene must outlive this.
  explicit PassingObstacles(const ExactScene& scene);

  /// After each scan, with the map that holds it. \param time of the scene, s.
  void add(const RangeData& scan, const Snapshot& map, double time);

  /// An entry for each obstacle that was seen; keys as documented in docs/evaluation.md.
  nlohmann::json json() const;

 private:
  /// A voxel that an obstacle occupied.
  struct Trace {
    VoxelIndex voxel;
    std::optional<double> seen_through;  // first time after the obstacle had left it, s
  };
  struct Obstacle {
    const ExactScene::Shape* shape;
    std::size_t number;                // in the scene's file, from 0
    std::optional<double> first_seen;  // s
    int scans_seen = 0;                // until it appeared
    std::optional<double> appeared;
    std::unordered_map<std::uint64_t, Trace> traces;
    std::vector<double> vanish_times;  // s
  };

  void look(const RangeData& scan, const Snapshot& map, double time, Obstacle* obstacle) const;
  void noteTraces(const Snapshot& map, double time, Obstacle* obstacle) const;
  void followTraces(const RangeData& scan, const Snapshot& map, double time,
                    Obstacle* obstacle) const;
  bool isSeenThrough(const RangeData& scan, const Eigen::Vector3d& center_W, double resolution,
                     double time) const;

  const ExactScene* scene_;
  std::vector<Obstacle> obstacles_;
};

}  // namespace fiimap
