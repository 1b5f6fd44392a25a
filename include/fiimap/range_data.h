#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fiimap/vector_room.h"

namespace fiimap {

/// Points as one array per coordinate, which is what vector instructions read and write: there is
/// room for kVectorRoom more. Keeps its memory when it shrinks.
class PointList {
 public:
  ///@{
  /// As of a std::vector.
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Eigen::Vector3f operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
  ///@}

  /// Reads points one by one, for range-based for loops.
  class Iterator {
   public:
    ///@{
    /// As of a forward iterator.
    Iterator(const PointList& list, std::size_t i) : list_(list), i_(i) {}
    Eigen::Vector3f operator*() const { return list_[i_]; }
    Iterator& operator++() { return ++i_, *this; }
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }
    ///@}

   private:
    const PointList& list_;
    std::size_t i_;
  };
  ///@{
  /// The first point and the end.
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size_}; }
  ///@}

  ///@{
  /// The points' coordinates along one axis: size() and kVectorRoom more, which hold anything.
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* z() const { return z_.data(); }
  float* x() { return x_.data(); }
  float* y() { return y_.data(); }
  float* z() { return z_.data(); }
  ///@}

  /// Removes all points.
  void clear() { size_ = 0; }
  /// Changes the size; new points hold anything.
  void resize(std::size_t size) {
    if (size + kVectorRoom > x_.size()) {
      for (auto* axis : {&x_, &y_, &z_}) axis->resize(size + kVectorRoom);
    }
    size_ = size;
  }
  /// Adds a point.
  void push_back(const Eigen::Vector3f& point) {
    resize(size_ + 1);
    x_[size_ - 1] = point.x();
    y_[size_ - 1] = point.y();
    z_[size_ - 1] = point.z();
  }

 private:
  std::size_t size_ = 0;
  std::vector<float> x_, y_, z_;  // as long as ever needed, and kVectorRoom
};

/// One scan in the world frame, whatever sensor it came from.
/// End points are offsets from the origin (metres, world axes), so that single precision suffices
/// however far the vehicle is from the world's origin.
struct RangeData {
  /// Position of the sensor in the world, metres.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Where rays met a surface.
  PointList returns;
  /// Where rays that met nothing were cut off: free space up to and including this point.
  PointList misses;
  /// Returns that a surface gives which fills a steradian of the view; 0 when not known.
  double returns_per_steradian = 0.0;

  /// Removes all rays; the origin stays.
  void clear() {
    returns.clear();
    misses.clear();
    returns_per_steradian = 0.0;
  }
};

/// How many readings of a scan were of which kind, after down-sampling.
struct ReadingCount {
  std::size_t total = 0;     ///< looked at
  std::size_t returns = 0;   ///< within range
  std::size_t invalid = 0;   ///< 0, NaN, or 65535 of 16 bits
  std::size_t too_near = 0;  ///< below min_depth or min_ray_length
  std::size_t infinite = 0;  ///< +inf
  std::size_t too_far = 0;   ///< beyond max_depth or max_ray_length
  std::size_t ignored = 0;   ///< in the vehicle's body or in an ignored sphere; none of `returns`
};

}  // namespace fiimap
