#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

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
constexpr double kLeastTravel = 1.5;      // m
constexpr float kPlace = 0.3F;            // m, edge of the places that clouds share
constexpr std::size_t kUpright = 3;       // places above each other
constexpr std::size_t kLeastPlaces = 30;  // to compare
constexpr double kLeastOverlap = 0.5;     // of the points of a cloud
constexpr double kClearlyMore = 2.0;      // times

using Place = std::tuple<int, int, int>;

Place placeOf(const Eigen::Vector3f& point) {
  return {static_cast<int>(std::floor(point.x() / kPlace)),
          static_cast<int>(std::floor(point.y() / kPlace)),
          static_cast<int>(std::floor(point.z() / kPlace))};
}

/// The places of upright things: walls, poles, trees. The ground below looks alike wherever a
/// vehicle goes.
std::set<Place> uprightPlaces(const std::vector<Eigen::Vector3f>& points) {
  std::map<std::pair<int, int>, std::set<int>> columns;
  for (const Eigen::Vector3f& point : points) {
    const auto [x, y, z] = placeOf(point);
    columns[{x, y}].insert(z);
  }
  std::set<Place> places;
  for (const auto& [column, heights] : columns) {
    if (heights.size() < kUpright) continue;
    for (const int z : heights) places.insert({column.first, column.second, z});
  }
  return places;
}

/// Share of the places of a cloud that another has too.
double overlap(const std::set<Place>& first, const std::set<Place>& second) {
  std::size_t common = 0;
  for (const Place& place : second) common += first.count(place);
  return static_cast<double>(common) / static_cast<double>(second.size());
}

std::vector<Eigen::Vector3f> moved(const Eigen::Isometry3d& T,
                                   std::vector<Eigen::Vector3f> points) {
  for (Eigen::Vector3f& point : points) point = T.cast<float>() * point;
  return points;
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
  if (poses == e->seen.poses.end() || figures.clouds < 2) return;
  const CloudFigures::Sample &first = figures.first, &last = figures.last;
  Eigen::Isometry3d T_first_last;
  try {
    T_first_last = decodeTransform(nearest(poses->second, first.stamp).transform).inverse() *
                   decodeTransform(nearest(poses->second, last.stamp).transform);
  } catch (const InputError&) {
    return;  // said elsewhere
  }
  const double travel = T_first_last.translation().norm();
  if (travel < kLeastTravel) return;
  const std::set<Place> before = uprightPlaces(first.points);
  const std::set<Place> still = uprightPlaces(last.points);
  const std::set<Place> moving = uprightPlaces(moved(T_first_last, last.points));
  if (std::min({before.size(), still.size(), moving.size()}) < kLeastPlaces) return;
  const double as_is = overlap(before, still), by_poses = overlap(before, moving);
  if (as_is < kLeastOverlap || as_is < kClearlyMore * by_poses) return;
  // A tunnel looks alike from everywhere, too.
  e->warn("The clouds of " + e->setup.points + " say frame '" + e->sensorFrame() +
              "', but their points seem to be in the world: between the first and the last the "
              "vehicle went " +
              withUnit(travel, "m", 1) + ", and " + percent(as_is) +
              " of what stands upright is at the same place in both (" + percent(by_poses) +
              " where the poses would put it).",
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
  if (figures.clouds == 0) return;
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
