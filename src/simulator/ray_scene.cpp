#include "ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "triangle_distance.h"

namespace fiimap::sim {
namespace {

/// What a distance query looks for, and what it found so far.
struct Nearest {
  const Mesh* mesh;
  Eigen::Vector3d point_W;
  double distance;
};

/// Called by Embree for every triangle that may be nearer than the query's radius.
bool considerTriangle(RTCPointQueryFunctionArguments* arguments) {
  auto* nearest = static_cast<Nearest*>(arguments->userPtr);
  const Mesh& mesh = *nearest->mesh;
  const double distance =
      distanceToTriangle(nearest->point_W, mesh, mesh.triangles[arguments->primID]);
  if (distance >= nearest->distance) return false;
  nearest->distance = distance;
  arguments->query->radius = static_cast<float>(distance);
  return true;  // the radius shrank
}

Mesh movingMesh(const World& world, double time) {
  Mesh all;
  for (const MovingObstacle& obstacle : world.moving) {
    Mesh mesh = obstacle.shape;
    mesh.translate(obstacle.positionAt(time).cast<float>());
    all.append(mesh);
  }
  return all;
}

}  // namespace

class RayScene::Device {
 public:
  Device() : device_(rtcNewDevice("threads=1")) {
    if (!device_) {
      throw std::runtime_error("Embree does not start: error " +
                               std::to_string(rtcGetDeviceError(nullptr)));
    }
  }
  ~Device() { rtcReleaseDevice(device_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  RTCDevice get() const { return device_; }

 private:
  RTCDevice device_;
};

/// A mesh with its tree of bounding boxes.
class RayScene::Geometry {
 public:
  Geometry(RTCDevice device, Mesh mesh)
      : mesh_(std::move(mesh)),
        scene_(rtcNewScene(device)),
        geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between triangles
    void* triangles = rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(Eigen::Vector3i), mesh_.triangles.size());
    std::memcpy(triangles, mesh_.triangles.data(),
                mesh_.triangles.size() * sizeof(Eigen::Vector3i));
    vertices_ = rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                        sizeof(Eigen::Vector3f), mesh_.vertices.size());
    rtcAttachGeometry(scene_, geometry_);
    commit();
  }
  ~Geometry() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
  }
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  /// Of the same triangles.
  void moveVertices(std::vector<Eigen::Vector3f> vertices) {
    mesh_.vertices = std::move(vertices);
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    commit();
  }

  void intersect(RTCRayHit16* rays) const {
    alignas(64) static constexpr int kAllValid[16] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                      -1, -1, -1, -1, -1, -1, -1, -1};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(kAllValid, scene_, &context, rays);
  }

  double distance(const Eigen::Vector3d& point_W, double farthest) const {
    RTCPointQuery query = {};
    query.x = static_cast<float>(point_W.x());
    query.y = static_cast<float>(point_W.y());
    query.z = static_cast<float>(point_W.z());
    query.radius = static_cast<float>(farthest);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    Nearest nearest = {&mesh_, point_W, farthest};
    rtcPointQuery(scene_, &query, &context, considerTriangle, &nearest);
    return nearest.distance;
  }

 private:
  void commit() {
    std::memcpy(vertices_, mesh_.vertices.data(), mesh_.vertices.size() * sizeof(Eigen::Vector3f));
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

  Mesh mesh_;
  RTCScene scene_;
  RTCGeometry geometry_;
  void* vertices_ = nullptr;
};

RayScene::RayScene(World world)
    : world_(std::move(world)),
      device_(std::make_unique<Device>()),
      still_(std::make_unique<Geometry>(device_->get(), world_.still)) {
  if (world_.moving.empty()) return;
  moving_ = std::make_unique<Geometry>(device_->get(), movingMesh(world_, 0.0));
}

RayScene::~RayScene() = default;

void RayScene::setTime(double time) {
  if (moving_) moving_->moveVertices(movingMesh(world_, time).vertices);
}

void RayScene::intersect(RTCRayHit16* rays) const {
  still_->intersect(rays);
  if (moving_) moving_->intersect(rays);  // shortens those that meet something nearer
}

double RayScene::distance(const Eigen::Vector3d& point_W, double time, double farthest) const {
  return distanceToMoving(point_W, time, still_->distance(point_W, farthest));
}

/// Without a tree: there are few, and most are too far away to look at their triangles.
double RayScene::distanceToMoving(const Eigen::Vector3d& point_W, double time,
                                  double farthest) const {
  double nearest = farthest;
  for (const MovingObstacle& obstacle : world_.moving) {
    const Mesh& mesh = obstacle.shape;
    const Eigen::Vector3d point = point_W - obstacle.positionAt(time);
    if (obstacle.bounds.exteriorDistance(point) >= nearest) continue;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      nearest = std::min(nearest, distanceToTriangle(point, mesh, t));
    }
  }
  return nearest;
}

}  // namespace fiimap::sim
