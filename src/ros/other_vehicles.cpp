#include "fiimap/ros/other_vehicles.h"

#include <sstream>
#include <stdexcept>

#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/geometry_messages.h"

namespace fiimap {
namespace {

// As OtherVehicle.msg says.
constexpr double kMaxRadius = 100.0;   // m
constexpr double kMaxLifetime = 60.0;  // s
constexpr double kFarAway = 1e9;       // m, beyond all maps

[[noreturn]] void refuseVehicles(const std::string& what) {
  throw std::invalid_argument("other vehicles: " + what);
}

void requireAllowed(const std::string& name, double value, double max, const std::string& unit) {
  if (value > 0.0 && value <= max) return;
  std::ostringstream text;
  text << name << " = " << value << ": must be above 0 and at most " << max << " " << unit;
  refuseVehicles(text.str());
}

}  // namespace

std::vector<IgnoredSphere> toIgnoredSpheres(const OtherVehicles& message,
                                            const std::string& map_frame) {
  if (plainFrame(message.header.frame_id) != map_frame) {
    refuseVehicles("they are in frame '" + message.header.frame_id + "', map_frame is '" +
                   map_frame + "'");
  }
  if (message.header.stamp.isZero()) refuseVehicles("the message has no stamp");
  std::vector<IgnoredSphere> spheres;
  for (const OtherVehicle& vehicle : message.vehicles) {
    requireAllowed("radius", vehicle.radius, kMaxRadius, "m");
    requireAllowed("lifetime", vehicle.lifetime.toSec(), kMaxLifetime, "s");
    IgnoredSphere sphere;
    sphere.center_W = toEigen(vehicle.position);
    if (!sphere.center_W.allFinite() || sphere.center_W.cwiseAbs().maxCoeff() > kFarAway) {
      refuseVehicles("a position is not finite, or more than 10^9 m away");
    }
    sphere.radius = vehicle.radius;
    sphere.stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
    sphere.lifetime_ns = vehicle.lifetime.toNSec();
    spheres.push_back(sphere);
  }
  return spheres;
}

}  // namespace fiimap
