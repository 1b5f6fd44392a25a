#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "doctor/checks.h"
#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/pose_history.h"
#include "fiimap/ros/stamps.h"
#include "quantiles.h"

namespace fiimap {
namespace {

constexpr double kFewPoints = 0.01;  // of the points

// Standing still, a scene looks alike in any frame: the vehicle must have moved by this.
constexpr double kLeastTravel = 1.5;   // m
constexpr float kPlace = 0.3F;         // m, edge of the places that clouds share
constexpr double kLeastOverlap = 0.5;  // of the points of a cloud
constexpr double kClearlyMore = 2.0;   // times

using Place = std::tuple<int, int, int>;

Place placeOf(const Eigen::Vector3f& point) {
  return {static_cast<int>(std::floor(point.x() / kPlace)),
          static_cast<int>(std::floor(point.y() / kPlace)),
          static_cast<int>(std::floor(point.z() / kPlace))};
}

std::set<Place> placesOf(const std::vector<Eigen::Vector3f>& points) {
  std::set<Place> places;
  for (const Eigen::Vector3f& point : points) places.insert(placeOf(point));
  return places;
}

/// Share of the places of a cloud, moved by T, that another has too.
double overlap(const std::vector<Eigen::Vector3f>& first,
               const std::vector<Eigen::Vector3f>& second, const Eigen::Isometry3d& T) {
  const std::set<Place> places = placesOf(first);
  std::vector<Eigen::Vector3f> moved;
  for (const Eigen::Vector3f& point : second) moved.push_back(T.cast<float>() * point);
  std::size_t common = 0;
  const std::set<Place> of_second = placesOf(moved);
  for (const Place& place : of_second) common += places.count(place);
  return of_second.empty() ? 0.0
                           : static_cast<double>(common) / static_cast<double>(of_second.size());
}

/// Pose message whose stamp is nearest; there must be some.
const geometry_msgs::TransformStamped& nearest(
    const std::vector<Received<geometry_msgs::TransformStamped>>& poses, const ros::Time& stamp) {
  const auto distance = [&stamp](const auto& pose) {
    return std::abs(secondsBetween(pose.message->header.stamp, stamp));
  };
  return *std::min_element(poses.begin(), poses.end(), [&distance](const auto& a, const auto& b) {
            return distance(a) < distance(b);
          })->message;
}

/// Clouds that stay where they are in their own frame while the vehicle moves.
void checkStandstill(const CloudFigures& figures, Examination* e) {
  const auto poses = e->seen.poses.find(e->setup.poses);
  if (poses == e->seen.poses.end() || figures.samples.size() < 2) return;
  const CloudFigures::Sample& first = figures.samples.front();
  const CloudFigures::Sample& last = figures.samples.back();
  Eigen::Isometry3d T_first_last;
  try {
    T_first_last = decodeTransform(nearest(poses->second, first.stamp).transform).inverse() *
                   decodeTransform(nearest(poses->second, last.stamp).transform);
  } catch (const InputError&) {
    return;  // said elsewhere
  }
  const double travel = T_first_last.translation().norm();
  if (travel < kLeastTravel) return;
  const double as_is = overlap(first.points, last.points, Eigen::Isometry3d::Identity());
  const double moved = overlap(first.points, last.points, T_first_last);
  if (as_is < kLeastOverlap || as_is < kClearlyMore * moved) return;
  e->error("The clouds of " + e->setup.points + " say frame '" + e->sensorFrame() +
               "', but their points are in the world: between the first and the last the vehicle "
               "went " +
               withUnit(travel, "m", 1) + ", and " + percent(as_is) +
               " of the places are the same in both (" + percent(moved) +
               " where the poses would put them).",
           "Use the cloud as the sensor gives it; rays must start at the origin of its frame.");
}

}  // namespace

void checkCloudPoints(Examination* e) {
  const auto found = e->seen.points.find(e->setup.points);
  if (found == e->seen.points.end()) return;
  const auto& [topic, figures] = *found;
  if (!figures.unreadable.empty()) {
    e->error("Clouds of " + topic + " cannot be read: " + figures.unreadable + ".",
             remedyFor(DropReason::kBadCloud) + ".");
  }
  if (figures.samples.empty()) return;
  if (figures.finite == 0) {
    e->error("No point of the clouds of " + topic + " is finite and away from the origin (" +
                 std::to_string(figures.points) + " looked at).",
             "Look at the sensor and its driver: covered, out of range, or not yet turning?");
  } else if (figures.finiteShare() < kFewPoints) {
    e->warn("Only " + percent(figures.finiteShare()) + " of the points of " + topic +
                " are finite and away from the origin.",
            "Look at the sensor: light, texture, range.");
  }
}

void checkCloudFrame(Examination* e) {
  const auto found = e->seen.points.find(e->setup.points);
  if (found == e->seen.points.end() || !e->hasScans()) return;
  const std::string frame = e->sensorFrame();
  if (e->setup.has_poses && frame == e->setup.node.map_frame) {
    std::vector<std::string> others;
    for (const auto& [topic, clouds] : e->seen.clouds) {
      const std::string of_other = plainFrame(clouds.front().message->header.frame_id);
      if (of_other != frame && !isOutputOfMap(topic, e->seen)) {
        others.push_back(topic + " ('" + of_other + "')");
      }
    }
    e->error("The clouds of " + found->first + " are already in the frame of the map, '" + frame +
                 "': where their rays start is lost.",
             "Use the cloud in the sensor's frame" +
                 (others.empty() ? std::string(", as its driver publishes it.")
                                 : ": " + listOf(others) + "; choose with --points TOPIC."));
    return;
  }
  checkStandstill(found->second, e);
}

}  // namespace fiimap
