#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <vector>

namespace fiimap {

/// The exact geometry of a synthetic recording (data/README.md describes the file).
/// Times are seconds since Scene::startTime().
class ExactScene {
 public:
  struct Shape {
    enum class Kind { kBox, kCylinder, kSphere };

    Kind kind = Kind::kBox;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Vector3d half_size = Eigen::Vector3d::Zero();  ///< in its own axes; radius, radius, ...
    Eigen::Matrix3d R_W_S = Eigen::Matrix3d::Identity();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    double on = -std::numeric_limits<double>::infinity();
    double off = std::numeric_limits<double>::infinity();

    bool alwaysThere() const { return on < off && !std::isfinite(on) && !std::isfinite(off); }
    bool exists(double time) const { return time >= on && time <= off; }
    /// Distance to the surface, negative inside, m.
    double signedDistance(const Eigen::Vector3d& point_W, double time) const;
    /// Distance along a ray to where it enters the shape, m; infinity when it does not. A ray that
    /// starts inside of a box or a sphere does not enter it.
    /// \param direction_W of length 1.
    double distanceAlong(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                         double time) const;
    /// Least distance while it exists, up to a time; for shapes that come and go.
    double distanceWhileThere(const Eigen::Vector3d& point_W,
                              double until = std::numeric_limits<double>::infinity()) const;

   private:
    Eigen::Vector3d toOwnAxes(const Eigen::Vector3d& point_W, double time) const;
  };

  /// \throws std::exception when the file cannot be read.
  static ExactScene load(const std::string& file);

  /// Stamp of time zero, s.
  double startTime() const { return start_time_; }
  const std::vector<Shape>& shapes() const { return shapes_; }
  /// Distance to the nearest surface that exists at a time.
  double signedDistance(const Eigen::Vector3d& point_W, double time) const;
  /// Distance to the nearest shape that comes, goes or moves, wherever it was up to a time.
  double distanceToPassing(const Eigen::Vector3d& point_W,
                           double until = std::numeric_limits<double>::infinity()) const;

  struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    const Shape* shape = nullptr;  ///< null: the ray meets nothing
  };
  /// What a ray meets first. \param direction_W of length 1.
  Hit firstHit(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
               double time) const;

 private:
  double start_time_ = 0.0;
  std::vector<Shape> shapes_;
};

}  // namespace fiimap
