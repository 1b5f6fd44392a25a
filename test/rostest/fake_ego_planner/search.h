#pragma once

#include <plan_env/grid_map.h>

/// Searches as ego-planner's path_searching does: in C++11, with a pool of cells of its own around
/// the middle between start and end, and a query for each cell that it comes to. Includes nothing
/// but the map's header, and takes names of std as that leaves them.
class FakeSearch {
 public:
  typedef std::shared_ptr<FakeSearch> Ptr;

  void initGridMap(GridMap::Ptr map, const Eigen::Vector3i pool_size);

  /// Points from start to end, `step` metres apart along an axis, none of them occupied; empty when
  /// there is no way. Start and end are moved apart until they are not occupied.
  vector<Eigen::Vector3d> search(const double step, Eigen::Vector3d start, Eigen::Vector3d end);

 private:
  bool isOccupied(const Eigen::Vector3d& point) { return (bool)map_->getInflateOccupancy(point); }
  Eigen::Vector3d pointOf(const Eigen::Vector3i& cell) const;
  bool cellOf(const Eigen::Vector3d& point, Eigen::Vector3i& cell) const;
  bool moveOut(Eigen::Vector3d point, const Eigen::Vector3d& other, Eigen::Vector3i& cell);
  int addressOf(const Eigen::Vector3i& cell) const;
  vector<Eigen::Vector3d> retrace(const vector<Eigen::Vector3i>& from, Eigen::Vector3i cell) const;

  GridMap::Ptr map_;
  Eigen::Vector3i pool_size_;
  Eigen::Vector3d center_;
  double step_;
};
