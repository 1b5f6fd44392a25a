#pragma once

#include <plan_env/grid_map.h>

#include "search.h"

/// Asks the map as ego-planner's bspline_opt and plan_manage do: in C++14, with columns of
/// matrices, sums of them and points of a curve of any dimension in the place of three coordinates.
class FakeOptimizer {
 public:
  typedef unique_ptr<FakeOptimizer> Ptr;

  void setEnvironment(const GridMap::Ptr& map) { map_ = map; }

  /// Whether the straight lines between the columns are free, looked at every half voxel.
  bool isFree(const Eigen::MatrixXd& points);

  FakeSearch::Ptr search_;

 private:
  /// A point of the polyline, t in columns.
  static Eigen::VectorXd evaluate(const Eigen::MatrixXd& points, double t);

  GridMap::Ptr map_;
};
