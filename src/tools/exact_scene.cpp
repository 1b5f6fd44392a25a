#include "exact_scene.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace fiimap {
namespace {

using Json = nlohmann::json;

Eigen::Vector3d vectorFrom(const Json& list) {
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

ExactScene::Shape shapeFrom(const Json& json) {
  ExactScene::Shape shape;
  const std::string type = json.at("type");
  shape.center = vectorFrom(json.at("center"));
  if (type == "box") {
    shape.half_size = vectorFrom(json.at("size")) / 2.0;
    shape.R_W_S =
        Eigen::AngleAxisd(json.value("yaw", 0.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  } else if (type == "cylinder") {
    shape.kind = ExactScene::Shape::Kind::kCylinder;
    const double radius = json.at("radius");
    shape.half_size = {radius, radius, json.at("length").get<double>() / 2.0};
    if (json.contains("axis")) {
      const Eigen::Vector3d axis = vectorFrom(json.at("axis")).normalized();
      shape.R_W_S =
          Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
    }
  } else if (type == "sphere") {
    shape.kind = ExactScene::Shape::Kind::kSphere;
    shape.half_size.setConstant(json.at("radius").get<double>());
  } else {
    throw std::runtime_error("unknown shape " + type);
  }
  if (json.contains("velocity")) shape.velocity = vectorFrom(json.at("velocity"));
  shape.on = json.value("t_on", shape.on);
  shape.off = json.value("t_off", shape.off);
  return shape;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Distance at which a ray enters the ball, or in two dimensions the circle, of a radius about 0.
template <typename Vector>
double alongRound(const Vector& origin, const Vector& direction, double radius) {
  const double a = direction.squaredNorm();
  const double b = direction.dot(origin);
  const double discriminant = b * b - a * (origin.squaredNorm() - radius * radius);
  if (a == 0.0 || discriminant <= 0.0) return kInfinity;
  const double distance = (-b - std::sqrt(discriminant)) / a;
  return distance > 0.0 ? distance : kInfinity;
}

double alongBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                const Eigen::Vector3d& half_size) {
  double enter = 0.0, exit = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (std::abs(origin[axis]) > half_size[axis]) return kInfinity;
      continue;
    }
    const double low = (-half_size[axis] - origin[axis]) / direction[axis];
    const double high = (half_size[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(low, high));
    exit = std::min(exit, std::max(low, high));
  }
  return enter > 0.0 && enter <= exit ? enter : kInfinity;
}

double alongCylinder(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double radius,
                     double half_length) {
  const auto at = [&](double distance) -> Eigen::Vector3d { return origin + distance * direction; };
  double nearest = alongRound<Eigen::Vector2d>(origin.head<2>(), direction.head<2>(), radius);
  if (std::isfinite(nearest) && std::abs(at(nearest).z()) > half_length) nearest = kInfinity;
  for (const double cap : {-half_length, half_length}) {
    const double distance = (cap - origin.z()) / direction.z();
    if (distance > 0.0 && distance < nearest && at(distance).head<2>().norm() <= radius) {
      nearest = distance;
    }
  }
  return nearest;
}

}  // namespace

Eigen::Vector3d ExactScene::Shape::toOwnAxes(const Eigen::Vector3d& point_W, double time) const {
  const double moving_for = std::isfinite(on) ? time - on : 0.0;
  return R_W_S.transpose() * (point_W - center - velocity * moving_for);
}

double ExactScene::Shape::signedDistance(const Eigen::Vector3d& point_W, double time) const {
  const Eigen::Vector3d p = toOwnAxes(point_W, time);
  if (kind == Kind::kSphere) return p.norm() - half_size.x();
  if (kind == Kind::kCylinder) {
    const Eigen::Vector2d q(p.head<2>().norm() - half_size.x(), std::abs(p.z()) - half_size.z());
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
  }
  const Eigen::Vector3d q = p.cwiseAbs() - half_size;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

double ExactScene::Shape::distanceAlong(const Eigen::Vector3d& origin_W,
                                        const Eigen::Vector3d& direction_W, double time) const {
  const Eigen::Vector3d origin = toOwnAxes(origin_W, time);
  const Eigen::Vector3d direction = R_W_S.transpose() * direction_W;
  // Most rays pass far from most shapes: the ball around a shape is tested first.
  if (origin.cross(direction).squaredNorm() > half_size.squaredNorm()) return kInfinity;
  if (kind == Kind::kBox) return alongBox(origin, direction, half_size);
  if (kind == Kind::kSphere) return alongRound(origin, direction, half_size.x());
  return alongCylinder(origin, direction, half_size.x(), half_size.z());
}

double ExactScene::Shape::distanceWhileThere(const Eigen::Vector3d& point_W, double until) const {
  constexpr double kTimeStep = 0.05;  // s
  double nearest = std::numeric_limits<double>::infinity();
  for (double time = on; time <= std::min(off, until); time += kTimeStep) {
    nearest = std::min(nearest, signedDistance(point_W, time));
  }
  return nearest;
}

ExactScene ExactScene::load(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::invalid_argument("cannot read the scene " + file);
  try {
    const Json json = Json::parse(stream);
    ExactScene scene;
    scene.start_time_ = json.at("t0");
    for (const Json& shape : json.at("primitives")) scene.shapes_.push_back(shapeFrom(shape));
    return scene;
  } catch (const Json::exception& error) {
    throw std::invalid_argument(file + " is no scene (data/README.md): " + error.what());
  }
}

double ExactScene::signedDistance(const Eigen::Vector3d& point_W, double time) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shape& shape : shapes_) {
    if (shape.exists(time)) nearest = std::min(nearest, shape.signedDistance(point_W, time));
  }
  return nearest;
}

double ExactScene::distanceToPassing(const Eigen::Vector3d& point_W, double until) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shape& shape : shapes_) {
    if (!shape.alwaysThere()) nearest = std::min(nearest, shape.distanceWhileThere(point_W, until));
  }
  return nearest;
}

ExactScene::Hit ExactScene::firstHit(const Eigen::Vector3d& origin_W,
                                     const Eigen::Vector3d& direction_W, double time) const {
  Hit first;
  for (const Shape& shape : shapes_) {
    if (!shape.exists(time)) continue;
    const double distance = shape.distanceAlong(origin_W, direction_W, time);
    if (distance < first.distance) first = {distance, &shape};
  }
  return first;
}

}  // namespace fiimap
