#include <array>
#include <vector>

#include "random.h"
#include "worlds/world.h"

namespace fiimap::sim {
namespace {

constexpr double kCell = 3.0;  // m between the middles of walls
constexpr double kWall = 0.2;  // m thick
constexpr double kHeight = 3.0;
constexpr double kFlightHeight = 1.3;

/// Every cell is reached from every other by exactly one way.
class MazeWalls {
 public:
  MazeWalls(int cells, Random* random) : cells_(cells) {
    const auto count = static_cast<std::size_t>(cells * cells);
    east_.assign(count, true);
    north_.assign(count, true);
    dig(random);
  }

  bool hasEastWall(int x, int y) const { return east_[indexOf(x, y)]; }
  bool hasNorthWall(int x, int y) const { return north_[indexOf(x, y)]; }

 private:
  std::size_t indexOf(int x, int y) const { return static_cast<std::size_t>(y * cells_ + x); }

  /// Walks to cells where it was not yet, in random directions, and steps back at dead ends.
  void dig(Random* random) {
    constexpr std::array<std::array<int, 2>, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    std::vector<bool> visited(east_.size(), false);
    std::vector<Eigen::Vector2i> way = {Eigen::Vector2i::Zero()};
    visited[0] = true;
    while (!way.empty()) {
      const Eigen::Vector2i cell = way.back();
      std::vector<Eigen::Vector2i> next;
      for (const auto& [dx, dy] : kSteps) {
        const Eigen::Vector2i n = cell + Eigen::Vector2i(dx, dy);
        const bool inside = n.minCoeff() >= 0 && n.maxCoeff() < cells_;
        if (inside && !visited[indexOf(n.x(), n.y())]) next.push_back(n);
      }
      if (next.empty()) {
        way.pop_back();
        continue;
      }
      const int choice = random->uniformInt(0, static_cast<int>(next.size()) - 1);
      const Eigen::Vector2i to = next[static_cast<std::size_t>(choice)];
      visited[indexOf(to.x(), to.y())] = true;
      // The wall between two cells belongs to the one with the smaller coordinates.
      const Eigen::Vector2i low = cell.cwiseMin(to);
      (cell.x() != to.x() ? east_ : north_)[indexOf(low.x(), low.y())] = false;
      way.push_back(to);
    }
  }

  int cells_;
  std::vector<bool> east_, north_;
};

}  // namespace

World makeMaze(const WorldConfig& config) {
  Random random(static_cast<std::uint64_t>(config.seed));
  const int cells = config.maze_cells;
  const MazeWalls walls(cells, &random);
  World world;
  Mesh& mesh = world.still;
  world.start_W = {0.0, 0.0, kFlightHeight};
  world.goal_W = {kCell * (cells - 1), kCell * (cells - 1), kFlightHeight};

  // Cells have their middles at whole multiples of kCell.
  const double low = -kCell / 2.0, high = kCell * (cells - 0.5), half = kWall / 2.0;
  mesh.addBoxBetween({low - half, low - half, -kWall}, {high + half, high + half, 0.0});
  mesh.addBoxBetween({low - half, low - half, kHeight},
                     {high + half, high + half, kHeight + kWall});
  mesh.addBoxBetween({low - half, low - half, 0.0}, {low + half, high + half, kHeight});
  mesh.addBoxBetween({low - half, low - half, 0.0}, {high + half, low + half, kHeight});
  for (int x = 0; x < cells; ++x) {
    for (int y = 0; y < cells; ++y) {
      const double west = kCell * x + low, east = west + kCell;
      const double south = kCell * y + low, north = south + kCell;
      if (walls.hasEastWall(x, y)) {
        mesh.addBoxBetween({east - half, south - half, 0.0}, {east + half, north + half, kHeight});
      }
      if (walls.hasNorthWall(x, y)) {
        mesh.addBoxBetween({west - half, north - half, 0.0}, {east + half, north + half, kHeight});
      }
    }
  }
  return world;
}

}  // namespace fiimap::sim
