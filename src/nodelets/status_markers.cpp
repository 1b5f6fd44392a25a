#include "status_markers.h"

#include <cstdio>
#include <vector>

#include "fiimap/ros/geometry_messages.h"
#include "fiimap/ros/map_messages.h"

namespace fiimap {
namespace {

using visualization_msgs::Marker;

constexpr double kTextHeight = 0.25;       // m, of a line
constexpr double kTextAboveVehicle = 1.5;  // m
constexpr double kGrown = 1.02;            // edges of markers, so that they cover the map's boxes
constexpr double kMegabyte = 1e6;

struct Color {
  float r, g, b;
};

// Of the palette of Okabe and Ito.
constexpr Color kGreen{0.0f, 0.62f, 0.45f}, kGrey{0.6f, 0.6f, 0.6f}, kOrange{0.90f, 0.62f, 0.0f},
    kRed{0.84f, 0.37f, 0.0f}, kBlue{0.34f, 0.71f, 0.91f}, kBlack{0.0f, 0.0f, 0.0f},
    kWhite{1.0f, 1.0f, 1.0f};

struct CellState {
  std::string text;
  Color color;
};

CellState stateOf(const Snapshot& snapshot, const Eigen::Vector3d& vehicle_W) {
  if (snapshot.occupancy(vehicle_W) == Occupancy::kOccupied) return {"in an obstacle", kRed};
  switch (snapshot.inflation(vehicle_W)) {
    case Inflation::kInflated:
      return {"in the inflation of an obstacle", kOrange};
    case Inflation::kUnknown:
      return {"in unknown space", kGrey};
    case Inflation::kFree:
      return {"in free space", kGreen};
    case Inflation::kOutside:
      break;
  }
  return {"outside of the map", kBlack};
}

Marker markerOf(const std::string& name, int type, Color color, const MapUpdate& update,
                const std::string& map_frame) {
  Marker marker;
  marker.header = toHeader(*update.snapshot, map_frame);
  marker.ns = name;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.color.r = color.r;
  marker.color.g = color.g;
  marker.color.b = color.b;
  marker.color.a = 1.0f;
  return marker;
}

std::string describe(const MapUpdate& update, const CellState& cell) {
  constexpr int kMaxText = 400;
  char text[kMaxText];
  std::snprintf(text, sizeof(text),
                "scan to map: %.2f ms\n%lld occupied, %lld inflated, %.1f MB\n"
                "%zu became occupied, %zu free\n%llu scans, %llu of them dropped\nvehicle %s",
                update.report.times_ms.total(),
                static_cast<long long>(update.snapshot->count(Plane::kOccupied)),
                static_cast<long long>(update.snapshot->count(Plane::kInflated)),
                static_cast<double>(update.memory_bytes) / kMegabyte, update.report.lower,
                update.report.raise, static_cast<unsigned long long>(update.counters.received),
                static_cast<unsigned long long>(update.counters.dropped()), cell.text.c_str());
  return text;
}

}  // namespace

visualization_msgs::MarkerArray toStatusMarkers(const MapUpdate& update, const Snapshot* before,
                                                const std::string& map_frame) {
  const Snapshot& snapshot = *update.snapshot;
  const double edge = kGrown * snapshot.lattice().resolution();
  const CellState state = stateOf(snapshot, update.pose.vehicle_W);

  Marker cell = markerOf("cell", Marker::CUBE, state.color, update, map_frame);
  cell.pose.position =
      toPoint(snapshot.lattice().centerOf(snapshot.lattice().indexOf(update.pose.vehicle_W)));
  cell.scale.x = cell.scale.y = cell.scale.z = edge;

  Marker text = markerOf("statistics", Marker::TEXT_VIEW_FACING, kWhite, update, map_frame);
  text.pose.position =
      toPoint(update.pose.vehicle_W + kTextAboveVehicle * Eigen::Vector3d::UnitZ());
  text.scale.z = kTextHeight;
  text.text = describe(update, state);

  Marker appeared = markerOf("appeared", Marker::CUBE_LIST, kRed, update, map_frame);
  Marker gone = markerOf("gone", Marker::CUBE_LIST, kBlue, update, map_frame);
  for (Marker* marker : {&appeared, &gone}) {
    marker->scale.x = marker->scale.y = marker->scale.z = edge;
  }
  if (before != nullptr) {
    for (const VoxelRun& run : snapshot.changes(Plane::kOccupied, before)) {
      for (int i = 0; i < run.count; ++i) {
        const VoxelIndex v = run.first + VoxelIndex(0, 0, i);
        const bool is_occupied = snapshot.occupancy(v) == Occupancy::kOccupied;
        (is_occupied ? appeared : gone).points.push_back(toPoint(snapshot.lattice().centerOf(v)));
      }
    }
  }

  visualization_msgs::MarkerArray markers;
  markers.markers = {cell, text};
  for (Marker* marker : {&appeared, &gone}) {
    // rviz warns of lists without points.
    if (marker->points.empty()) marker->action = Marker::DELETE;
    markers.markers.push_back(*marker);
  }
  return markers;
}

visualization_msgs::MarkerArray noStatusMarkers(const std::string& map_frame) {
  visualization_msgs::MarkerArray markers;
  markers.markers.resize(1);
  markers.markers[0].header.frame_id = map_frame;
  markers.markers[0].action = Marker::DELETEALL;
  return markers;
}

}  // namespace fiimap
