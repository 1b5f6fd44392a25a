// Calls GridMap as ego-planner does: one thread that spins callbacks and plans in between, in inner
// loops that convert every answer to bool. Answers ~report with what it found. Built in C++14.

#include <chrono>
#include <cmath>
#include <sstream>

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <plan_env/grid_map.h>

#include "optimizer.h"

namespace {

constexpr double kReach = 5.0;  // m
constexpr int kQueriesPerPlan = 100000;
constexpr double kPlanningPeriod = 0.1;  // s
constexpr double kSearchStep = 0.1;      // m
constexpr int kPoolSize = 100;           // cells

class FakeEgoPlanner {
 public:
  explicit FakeEgoPlanner(ros::NodeHandle& nh) {
    map_.reset(new GridMap);
    map_->initMap(nh);
    optimizer_.reset(new FakeOptimizer);
    optimizer_->setEnvironment(map_);
    optimizer_->search_.reset(new FakeSearch);
    optimizer_->search_->initGridMap(map_, Eigen::Vector3i::Constant(kPoolSize));
    timer_ = nh.createWallTimer(ros::WallDuration(kPlanningPeriod), &FakeEgoPlanner::plan, this);
    server_ = nh.advertiseService("report", &FakeEgoPlanner::report, this);
  }

 private:
  /// Looks at the neighbourhood of points on a way, as a search and an optimiser do. The map must
  /// not change meanwhile.
  void plan(const ros::WallTimerEvent&) {
    const double first = firstObstacle(true);
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kQueriesPerPlan; ++i) {
      const Eigen::Vector3d point(kReach * (i % 97) / 97.0, (i % 13) * 0.1 - 0.6, (i % 7) * 0.1);
      if (bool(map_->getInflateOccupancy(point))) ++hits_;
    }
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
    ns_per_query_ = spent.count() / kQueriesPerPlan;
    if (firstObstacle(true) != first) ++changes_;
    ++plans_;
  }

  /// First point ahead that is an obstacle; kReach: none.
  double firstObstacle(bool inflated) {
    for (double x = 0.0; x < kReach; x += map_->getResolution()) {
      const Eigen::Vector3d point(x, 0.0, 1.0);
      const int state = inflated ? map_->getInflateOccupancy(point) : map_->getOccupancy(point);
      if (bool(state)) return x;
    }
    return kReach;
  }

  /// A way to behind the wall, as the columns of a matrix; without any where there is none.
  Eigen::MatrixXd detour() {
    const vector<Eigen::Vector3d> way =
        optimizer_->search_->search(kSearchStep, straight().col(0), straight().col(1));
    Eigen::MatrixXd points(3, way.size());
    for (size_t i = 0; i < way.size(); ++i) points.col(i) = way[i];
    return points;
  }

  /// From middle to middle of a voxel, so that rounding does not choose between two of them.
  static Eigen::MatrixXd straight() {
    Eigen::MatrixXd points(3, 2);
    points << 0.55, 4.55, 0.05, 0.05, 1.05, 1.05;
    return points;
  }

  bool report(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    std::ostringstream text;
    const Eigen::MatrixXd way = detour();
    text << "resolution=" << map_->getResolution() << " inflated=" << firstObstacle(true)
         << " occupied=" << firstObstacle(false)
         << " outside=" << map_->getInflateOccupancy({100.0, 0.0, 1.0})
         << " ceiling=" << map_->getInflateOccupancy({0.0, 0.0, 2.6})
         << " not_finite=" << map_->getInflateOccupancy({std::nan(""), 0.0, 1.0})
         << " timeout=" << map_->getOdomDepthTimeout() << " plans=" << plans_
         << " straight_free=" << optimizer_->isFree(straight()) << " detour_points=" << way.cols()
         << " detour_free=" << optimizer_->isFree(way) << " changes=" << changes_
         << " ns=" << ns_per_query_ << " hits=" << hits_;
    response.success = true;
    response.message = text.str();
    return true;
  }

  GridMap::Ptr map_;
  FakeOptimizer::Ptr optimizer_;
  ros::WallTimer timer_;
  ros::ServiceServer server_;
  std::uint64_t plans_ = 0, changes_ = 0, hits_ = 0;
  double ns_per_query_ = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "ego_planner_node");
  ros::NodeHandle nh("~");
  FakeEgoPlanner planner(nh);
  ros::spin();
  return 0;
}
