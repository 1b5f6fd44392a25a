#include "fiimap/ros/geometry_messages.h"
#include "simulator_messages.h"

namespace fiimap::sim {
namespace {

constexpr float kWorldColor[3] = {0.55f, 0.5f, 0.42f};
constexpr float kMovingColor[3] = {0.9f, 0.4f, 0.1f};
constexpr float kVehicleColor[3] = {0.1f, 0.4f, 0.9f};
constexpr float kGoalColor[3] = {0.1f, 0.8f, 0.2f};
constexpr double kGoalSize = 0.5;  // m

visualization_msgs::Marker makeMarker(int type, const std::string& name, int id,
                                      const Eigen::Vector3d& position_W, double size,
                                      const float (&color)[3], const std_msgs::Header& header) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.position = toPoint(position_W);
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color.r = color[0];
  marker.color.g = color[1];
  marker.color.b = color[2];
  marker.color.a = 1.0f;
  return marker;
}

void addTriangles(const Mesh& mesh, visualization_msgs::Marker* marker) {
  marker->points.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (const int corner : {triangle[0], triangle[1], triangle[2]}) {
      marker->points.push_back(
          toPoint(mesh.vertices[static_cast<std::size_t>(corner)].cast<double>()));
    }
  }
}

}  // namespace

visualization_msgs::MarkerArray toWorldMarkers(const World& world, const std_msgs::Header& header) {
  using visualization_msgs::Marker;
  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(makeMarker(Marker::TRIANGLE_LIST, "world", 0, Eigen::Vector3d::Zero(),
                                       1.0, kWorldColor, header));
  addTriangles(world.still, &markers.markers.back());
  markers.markers.push_back(
      makeMarker(Marker::SPHERE, "goal", 0, world.goal_W, kGoalSize, kGoalColor, header));
  return markers;
}

visualization_msgs::MarkerArray toMovingMarkers(const World& world, double time,
                                                const Quadrotor::State& vehicle, double radius,
                                                const std_msgs::Header& header) {
  using visualization_msgs::Marker;
  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(makeMarker(Marker::SPHERE, "vehicle", 0, vehicle.position_W,
                                       2.0 * radius, kVehicleColor, header));
  int id = 0;
  for (const MovingObstacle& obstacle : world.moving) {
    markers.markers.push_back(makeMarker(Marker::TRIANGLE_LIST, "moving", id++,
                                         obstacle.positionAt(time), 1.0, kMovingColor, header));
    addTriangles(obstacle.shape, &markers.markers.back());
  }
  return markers;
}

}  // namespace fiimap::sim
