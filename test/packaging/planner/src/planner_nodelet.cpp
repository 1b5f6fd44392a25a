#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <pluginlib/class_list_macros.hpp>

#include "readme_planner.h"  // scripts/test_packaging takes it from the README

namespace fiimap_readme_planner {

/// The planner of the README; the parameter ~obstacles says how many occupied voxels it keeps out
/// of. Fewer than there are, and the parameter ~missed says how many it does not.
class PlannerNodelet : public ::PlannerNodelet {
 public:
  void onInit() override {
    ::PlannerNodelet::onInit();
    timer_ = getNodeHandle().createWallTimer(ros::WallDuration(0.5),
                                             [this](const ros::WallTimerEvent&) { look(); });
  }

 private:
  void look() {
    const auto snapshot = map_ ? map_->latest() : nullptr;
    if (!snapshot) return;
    int obstacles = 0;
    int missed = 0;
    for (const auto& v : snapshot->voxels(fiimap::Plane::kOccupied, snapshot->window())) {
      (isBlocked(snapshot->lattice().centerOf(v)) ? obstacles : missed) += 1;
    }
    if (map_->latest() != snapshot) return;  // some of the answers were from a newer one
    getPrivateNodeHandle().setParam("missed", missed);
    getPrivateNodeHandle().setParam("obstacles", obstacles);
  }

  ros::WallTimer timer_;
};

}  // namespace fiimap_readme_planner

PLUGINLIB_EXPORT_CLASS(fiimap_readme_planner::PlannerNodelet, nodelet::Nodelet)
