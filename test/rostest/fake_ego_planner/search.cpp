#include "search.h"

namespace {

const Eigen::Vector3i kNowhere(-1, -1, -1);

}  // namespace

void FakeSearch::initGridMap(GridMap::Ptr map, const Eigen::Vector3i pool_size) {
  map_ = map;
  pool_size_ = pool_size;
}

vector<Eigen::Vector3d> FakeSearch::search(const double step, Eigen::Vector3d start,
                                           Eigen::Vector3d end) {
  step_ = step;
  center_ = (start + end) / 2;
  Eigen::Vector3i first, last;
  if (!moveOut(start, end, first) || !moveOut(end, start, last)) return {};
  vector<Eigen::Vector3i> from(pool_size_.prod(), kNowhere);
  queue<Eigen::Vector3i> open;
  from[addressOf(first)] = first;
  open.push(first);
  while (!open.empty()) {
    const Eigen::Vector3i cell = open.front();
    open.pop();
    if (cell == last) return retrace(from, cell);
    for (int k = 0; k < 6; ++k) {
      Eigen::Vector3i next = cell;
      next[k / 2] += k % 2 == 0 ? 1 : -1;
      if ((next.array() < 0).any() || (next.array() >= pool_size_.array()).any()) continue;
      if (from[addressOf(next)] != kNowhere || isOccupied(pointOf(next))) continue;
      from[addressOf(next)] = cell;
      open.push(next);
    }
  }
  return {};
}

Eigen::Vector3d FakeSearch::pointOf(const Eigen::Vector3i& cell) const {
  return (cell - pool_size_ / 2).cast<double>() * step_ + center_;
}

bool FakeSearch::cellOf(const Eigen::Vector3d& point, Eigen::Vector3i& cell) const {
  cell = ((point - center_) / step_).array().round().cast<int>().matrix() + pool_size_ / 2;
  return (cell.array() >= 0).all() && (cell.array() < pool_size_.array()).all();
}

bool FakeSearch::moveOut(Eigen::Vector3d point, const Eigen::Vector3d& other,
                         Eigen::Vector3i& cell) {
  if (!cellOf(point, cell)) return false;
  while (isOccupied(pointOf(cell))) {
    point = (point - other).normalized() * step_ + point;
    if (!cellOf(point, cell)) return false;
  }
  return true;
}

int FakeSearch::addressOf(const Eigen::Vector3i& cell) const {
  return (cell.x() * pool_size_.y() + cell.y()) * pool_size_.z() + cell.z();
}

vector<Eigen::Vector3d> FakeSearch::retrace(const vector<Eigen::Vector3i>& from,
                                            Eigen::Vector3i cell) const {
  vector<Eigen::Vector3d> path;
  for (; from[addressOf(cell)] != cell; cell = from[addressOf(cell)]) path.push_back(pointOf(cell));
  path.push_back(pointOf(cell));
  reverse(path.begin(), path.end());
  return path;
}
