#include <cmath>
#include <vector>

#include "random.h"
#include "worlds/world.h"

namespace fiimap::sim {
namespace {

constexpr double kForestMargin = 10.0;       // m of forest behind the start and beyond the goal
constexpr double kClearRadius = 3.0;         // m around start and goal
constexpr double kForestFlightHeight = 1.5;  // m
constexpr double kGroundThickness = 0.2;
constexpr double kBushesPerTree = 0.3;
constexpr int kTrunkSides = 12;
constexpr int kBranchSides = 5;

/// Where something stands, with the radius that it takes from the ground.
struct Stand {
  Eigen::Vector2d center_W;
  double radius;
};

class ForestMaker {
 public:
  explicit ForestMaker(const WorldConfig& config)
      : config_(config), random_(static_cast<std::uint64_t>(config.seed)) {}

  World make() {
    world_.start_W = {0.0, 0.0, kForestFlightHeight};
    world_.goal_W = {config_.length, 0.0, kForestFlightHeight};
    world_.still.addBoxBetween({-kForestMargin, -half_width(), -kGroundThickness},
                               {config_.length + kForestMargin, half_width(), 0.0});
    for (const Eigen::Vector3d& place_W : {world_.start_W, world_.goal_W}) {
      stands_.push_back({place_W.head<2>(), kClearRadius});
    }
    const double area = config_.width * (config_.length + 2.0 * kForestMargin);
    const auto trees = static_cast<int>(std::lround(config_.tree_density * area));
    for (int i = 0; i < trees; ++i) addTree();
    for (int i = 0; i < kBushesPerTree * trees; ++i) addBush();
    return world_;
  }

 private:
  double half_width() const { return config_.width / 2.0; }

  /// A free place with the least gap to all others; false when there is none.
  bool findStand(double radius, Eigen::Vector2d* center_W) {
    constexpr int kTries = 20;
    for (int i = 0; i < kTries; ++i) {
      *center_W = {random_.uniform(-kForestMargin, config_.length + kForestMargin),
                   random_.uniform(-half_width(), half_width())};
      bool is_free = true;
      for (const Stand& stand : stands_) {
        const double gap = (stand.center_W - *center_W).norm() - stand.radius - radius;
        is_free = is_free && gap >= config_.least_gap;
      }
      if (is_free) {
        stands_.push_back({*center_W, radius});
        return true;
      }
    }
    return false;
  }

  void addTree() {
    const double radius = random_.uniform(0.10, 0.28);
    const double height = random_.uniform(4.0, 7.0);
    Eigen::Vector2d center_W;
    if (!findStand(radius, &center_W)) return;
    const double lean = random_.uniform(0.0, 0.12), lean_to = random_.uniform(-M_PI, M_PI);
    const Eigen::Vector3d foot(center_W.x(), center_W.y(), 0.0);
    const Eigen::Vector3d up(lean * std::cos(lean_to), lean * std::sin(lean_to), 1.0);
    const Eigen::Vector3d top = foot + height * up;
    world_.still.addCylinder(foot, top, radius, 0.5 * radius, kTrunkSides);
    for (int branches = random_.uniformInt(3, 7); branches > 0; --branches) {
      const double at = random_.uniform(1.2, height);
      addBranch(foot + at * up, radius * random_.uniform(0.15, 0.35));
    }
    const double crown = random_.uniform(0.7, 1.4);
    world_.still.addEllipsoid(top, {crown, crown, 0.8 * crown});
  }

  void addBranch(const Eigen::Vector3d& from, double radius) {
    const double direction = random_.uniform(-M_PI, M_PI);
    const double length = random_.uniform(0.4, 1.2), rise = random_.uniform(-0.1, 0.7);
    const Eigen::Vector3d to =
        from + length * Eigen::Vector3d(std::cos(direction), std::sin(direction), rise);
    world_.still.addCylinder(from, to, radius, 0.4 * radius, kBranchSides);
  }

  void addBush() {
    const double radius = random_.uniform(0.25, 0.7);
    Eigen::Vector2d center_W;
    if (!findStand(radius, &center_W)) return;
    const double half_height = random_.uniform(0.2, 0.8);
    world_.still.addEllipsoid({center_W.x(), center_W.y(), 0.6 * half_height},
                              {radius, radius, half_height});
  }

  const WorldConfig& config_;
  Random random_;
  World world_;
  std::vector<Stand> stands_;
};

}  // namespace

World makeForest(const WorldConfig& config) { return ForestMaker(config).make(); }

}  // namespace fiimap::sim
