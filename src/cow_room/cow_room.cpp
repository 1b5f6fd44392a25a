#include "cow_room.h"

#include <utility>

#include "mesh.h"

namespace fiimap {
namespace {

using Eigen::Vector3d;

// Of the room, m.
constexpr double kLowX = -4.6, kHighX = 6.0, kLowY = -4.8, kHighY = 6.1;
constexpr double kFloor = -0.35, kCeiling = 3.6;
constexpr double kWall = 0.2;
constexpr int kSides = 16;  // of round things

void addShell(sim::Mesh* mesh) {
  const Vector3d low(kLowX - kWall, kLowY - kWall, kFloor - kWall);
  const Vector3d high(kHighX + kWall, kHighY + kWall, kCeiling + kWall);
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d inner_high = high, inner_low = low;
    inner_high[axis] = low[axis] + kWall;
    inner_low[axis] = high[axis] - kWall;
    mesh->addBoxBetween(low, inner_high);
    mesh->addBoxBetween(inner_low, high);
  }
}

/// An upright post or a round thing on the floor.
void addPost(double x, double y, double height, double radius, sim::Mesh* mesh) {
  mesh->addCylinder({x, y, kFloor}, {x, y, kFloor + height}, radius, radius, kSides);
}

/// Head towards +x, 1.5 m long.
void addCow(const Vector3d& feet, sim::Mesh* mesh) {
  const auto at = [&feet](double x, double y, double z) {
    return Vector3d(feet + Vector3d(x, y, z));
  };
  for (const double x : {-0.42, 0.38}) {
    for (const double y : {-0.14, 0.14}) {
      mesh->addCylinder(at(x, y, 0.0), at(x, y, 0.55), 0.05, 0.07, kSides);
    }
  }
  mesh->addEllipsoid(at(0.0, 0.0, 0.75), {0.62, 0.24, 0.27});
  mesh->addCylinder(at(0.5, 0.0, 0.85), at(0.75, 0.0, 1.1), 0.16, 0.12, kSides);
  mesh->addEllipsoid(at(0.85, 0.0, 1.1), {0.2, 0.12, 0.13});
  mesh->addCylinder(at(0.74, 0.1, 1.2), at(0.7, 0.24, 1.32), 0.025, 0.01, kSides);
  mesh->addCylinder(at(0.74, -0.1, 1.2), at(0.7, -0.24, 1.32), 0.025, 0.01, kSides);
  mesh->addCylinder(at(-0.6, 0.0, 0.85), at(-0.72, 0.0, 0.35), 0.03, 0.02, kSides);
}

/// Stands, arms down; 1.72 m tall.
void addLady(const Vector3d& feet, sim::Mesh* mesh) {
  const auto at = [&feet](double x, double y, double z) {
    return Vector3d(feet + Vector3d(x, y, z));
  };
  mesh->addCylinder(at(0, 0, 0), at(0, 0, 0.03), 0.2, 0.2, kSides);
  for (const double y : {-0.09, 0.09}) {
    mesh->addCylinder(at(0, y, 0.03), at(0, y, 0.85), 0.05, 0.08, kSides);
    mesh->addCylinder(at(0, 2.6 * y, 0.75), at(0, 2.1 * y, 1.38), 0.035, 0.05, kSides);
  }
  mesh->addEllipsoid(at(0, 0, 0.95), {0.13, 0.18, 0.17});
  mesh->addCylinder(at(0, 0, 0.95), at(0, 0, 1.4), 0.11, 0.16, kSides);
  mesh->addCylinder(at(0, 0, 1.4), at(0, 0, 1.52), 0.05, 0.05, kSides);
  mesh->addEllipsoid(at(0, 0, 1.61), {0.1, 0.08, 0.12});
}

/// Between two corners on the floor: a plate on four legs, and a screen on it.
void addDesk(double x0, double y0, double x1, double y1, sim::Mesh* mesh) {
  constexpr double kHeight = 0.75, kPlate = 0.04, kInset = 0.06, kLeg = 0.03;
  const double top = kFloor + kHeight;
  mesh->addBoxBetween({x0, y0, top - kPlate}, {x1, y1, top});
  for (const double x : {x0 + kInset, x1 - kInset}) {
    for (const double y : {y0 + kInset, y1 - kInset}) addPost(x, y, kHeight, kLeg, mesh);
  }
  const double x = (x0 + x1) / 2, y = (y0 + y1) / 2;
  mesh->addBox({x, y, top + 0.3}, {0.5, 0.05, 0.35}, 0.4);
  mesh->addBox({x, y, top + 0.07}, {0.1, 0.1, 0.14});
}

void addChair(double x, double y, double yaw, sim::Mesh* mesh) {
  addPost(x, y, 0.45, 0.04, mesh);
  mesh->addBox({x, y, kFloor + 0.47}, {0.45, 0.45, 0.06}, yaw);
  const Vector3d back = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Vector3d(-0.21, 0.0, 0.0);
  mesh->addBox({x + back.x(), y + back.y(), kFloor + 0.8}, {0.04, 0.42, 0.55}, yaw);
}

/// Boards between two side walls.
void addShelf(double x0, double y0, double x1, double y1, sim::Mesh* mesh) {
  constexpr double kHeight = 2.0, kBoard = 0.03, kStep = 0.39;
  for (double z = kFloor; z < kFloor + kHeight; z += kStep) {
    mesh->addBoxBetween({x0, y0, z}, {x1, y1, z + kBoard});
  }
  mesh->addBoxBetween({x0, y0, kFloor}, {x0 + kBoard, y1, kFloor + kHeight});
  mesh->addBoxBetween({x1 - kBoard, y0, kFloor}, {x1, y1, kFloor + kHeight});
}

/// What hangs below the ceiling: beams of the tracking cameras, the cameras, lamps, a duct.
void addCeiling(sim::Mesh* mesh) {
  for (const double y : {-3.6, 4.6}) {
    mesh->addBoxBetween({kLowX, y, 3.0}, {kHighX, y + 0.06, 3.06});
    for (double x = -4.0; x < kHighX; x += 1.8) {
      mesh->addBox({x, y + 0.03, 2.9}, {0.1, 0.1, 0.14}, 0.3);
    }
  }
  for (double x = -3.0; x < kHighX; x += 2.4) {
    mesh->addBoxBetween({x, -1.5, 3.35}, {x + 0.2, 2.5, 3.42});
  }
  mesh->addCylinder({kLowX, 5.4, 3.2}, {kHighX, 5.4, 3.2}, 0.2, 0.2, kSides);
}

}  // namespace

sim::World makeCowRoom() {
  sim::World world;
  sim::Mesh& mesh = world.still;
  addShell(&mesh);
  addCow({1.95, -0.95, kFloor}, &mesh);
  addLady({-0.75, -0.45, kFloor}, &mesh);
  addDesk(4.6, -2.4, 5.4, -0.6, &mesh);
  addDesk(4.6, 0.2, 5.4, 2.0, &mesh);
  addDesk(-2.6, 4.6, -0.8, 5.4, &mesh);
  addChair(4.2, -1.4, 0.2, &mesh);
  addChair(4.1, 1.2, -0.5, &mesh);
  addChair(-1.6, 4.2, 1.3, &mesh);
  addShelf(1.0, 5.6, 3.4, kHighY, &mesh);
  addShelf(-3.4, kLowY, -1.4, kLowY + 0.4, &mesh);
  mesh.addBoxBetween({kLowX, 0.5, kFloor}, {kLowX + 0.5, 2.3, kFloor + 1.9});    // cupboard
  mesh.addBoxBetween({kLowX, -2.4, kFloor}, {kLowX + 0.1, -1.4, kFloor + 2.1});  // door
  mesh.addBox({0.6, -3.6, kFloor + 0.3}, {0.8, 0.6, 0.6}, 0.5);                  // crates
  mesh.addBox({0.7, -3.6, kFloor + 0.8}, {0.5, 0.4, 0.4}, 0.9);
  mesh.addBox({-3.3, -0.6, kFloor + 0.4}, {0.5, 0.7, 0.8}, -0.3);
  for (const auto& [x, y] : {std::pair(3.6, -3.4), std::pair(-3.6, 3.6), std::pair(3.8, 3.8)}) {
    addPost(x, y, 2.4, 0.03, &mesh);  // stands
    mesh.addBox({x, y, kFloor + 2.4}, {0.12, 0.12, 0.2}, 0.7);
  }
  addPost(5.6, 4.8, kCeiling - kFloor, 0.25, &mesh);  // column
  addPost(2.6, 3.4, 0.7, 0.2, &mesh);                 // bin
  addCeiling(&mesh);
  return world;
}

}  // namespace fiimap
