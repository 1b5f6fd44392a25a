#include "ray_bundle.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fiimap::sim {
namespace {

constexpr std::size_t kPacket = 16;

/// Sets origins and limits, which all packets of a cast share.
void setOrigin(const Eigen::Vector3f& origin_W, float longest, RTCRay16* rays) {
  std::fill_n(rays->org_x, kPacket, origin_W.x());
  std::fill_n(rays->org_y, kPacket, origin_W.y());
  std::fill_n(rays->org_z, kPacket, origin_W.z());
  std::fill_n(rays->tnear, kPacket, 0.0f);
  std::fill_n(rays->time, kPacket, 0.0f);
  std::fill_n(rays->mask, kPacket, ~0u);
  std::fill_n(rays->id, kPacket, 0u);
  std::fill_n(rays->flags, kPacket, 0u);
  std::fill_n(rays->tfar, kPacket, longest);
}

float cosIncidence(const RTCRayHit16& packet, std::size_t i) {
  const Eigen::Vector3f ray(packet.ray.dir_x[i], packet.ray.dir_y[i], packet.ray.dir_z[i]);
  const Eigen::Vector3f normal(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]);
  return std::abs(ray.dot(normal)) / std::sqrt(ray.squaredNorm() * normal.squaredNorm());
}

}  // namespace

RayBundle::RayBundle(std::vector<Eigen::Vector3f> directions_S)
    : directions_S_(std::move(directions_S)) {}

const RayHits& RayBundle::cast(const RayScene& scene, const Eigen::Isometry3d& T_W_S,
                               double longest, bool with_incidence) {
  hits_.lengths.resize(size());
  hits_.cos_incidence.resize(with_incidence ? size() : 0);
  const Eigen::Matrix3f R_W_S = T_W_S.linear().cast<float>();
  RTCRayHit16 packet;
  setOrigin(T_W_S.translation().cast<float>(), static_cast<float>(longest), &packet.ray);
  for (std::size_t first = 0; first < size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, size() - first);
    for (std::size_t i = 0; i < kPacket; ++i) {
      // The last packet is filled up with its last ray.
      const Eigen::Vector3f ray_W = R_W_S * directions_S_[first + std::min(i, count - 1)];
      packet.ray.dir_x[i] = ray_W.x();
      packet.ray.dir_y[i] = ray_W.y();
      packet.ray.dir_z[i] = ray_W.z();
      packet.ray.tfar[i] = static_cast<float>(longest);
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    scene.intersect(&packet);
    for (std::size_t i = 0; i < count; ++i) {
      const bool met = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      hits_.lengths[first + i] = met ? packet.ray.tfar[i] : std::numeric_limits<float>::infinity();
      if (with_incidence) hits_.cos_incidence[first + i] = met ? cosIncidence(packet, i) : 0.0f;
    }
  }
  return hits_;
}

}  // namespace fiimap::sim
