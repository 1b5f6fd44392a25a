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

}  // namespace

double ExactScene::Shape::signedDistance(const Eigen::Vector3d& point_W, double time) const {
  const double moving_for = std::isfinite(on) ? time - on : 0.0;
  const Eigen::Vector3d p = R_W_S.transpose() * (point_W - center - velocity * moving_for);
  if (kind == Kind::kSphere) return p.norm() - half_size.x();
  if (kind == Kind::kCylinder) {
    const Eigen::Vector2d q(p.head<2>().norm() - half_size.x(), std::abs(p.z()) - half_size.z());
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
  }
  const Eigen::Vector3d q = p.cwiseAbs() - half_size;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

double ExactScene::Shape::distanceWhileThere(const Eigen::Vector3d& point_W) const {
  constexpr double kTimeStep = 0.05;  // s
  double nearest = std::numeric_limits<double>::infinity();
  for (double time = on; time <= off; time += kTimeStep) {
    nearest = std::min(nearest, signedDistance(point_W, time));
  }
  return nearest;
}

ExactScene ExactScene::load(const std::string& file) {
  std::ifstream stream(file);
  const Json json = Json::parse(stream);
  ExactScene scene;
  scene.start_time_ = json.at("t0");
  for (const Json& shape : json.at("primitives")) scene.shapes_.push_back(shapeFrom(shape));
  return scene;
}

double ExactScene::signedDistance(const Eigen::Vector3d& point_W, double time) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shape& shape : shapes_) {
    if (shape.exists(time)) nearest = std::min(nearest, shape.signedDistance(point_W, time));
  }
  return nearest;
}

double ExactScene::distanceToPassing(const Eigen::Vector3d& point_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shape& shape : shapes_) {
    if (!shape.alwaysThere()) nearest = std::min(nearest, shape.distanceWhileThere(point_W));
  }
  return nearest;
}

}  // namespace fiimap
