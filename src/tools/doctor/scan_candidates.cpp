#include "doctor/scan_candidates.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "fiimap/ros/frame_id.h"
#include "quantiles.h"

namespace fiimap {
namespace {

/// Below it, an image of 16 bits may as well be a LiDAR's or a thermal camera's.
constexpr int kLikelyDepth = 2;
constexpr double kCameraRange = 10.0;  // m; what sees farther is a LiDAR
constexpr double kSameDevice = 0.2;    // m between the frames of one device
constexpr double kSameView = 15.0;     // degrees between them

bool hasWord(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

int likelihood(const std::string& depth_image, const Examination& e) {
  return 4 * static_cast<int>(e.seen.infos.count(infoBeside(depth_image))) +
         2 * static_cast<int>(hasWord(depth_image, "depth")) +
         static_cast<int>(hasWord(depth_image, "rect"));
}

/// Of the map, or of another world that poses are in.
bool isInWorld(const std::string& frame, const Observation& seen) {
  return std::any_of(seen.poses.begin(), seen.poses.end(), [&frame](const auto& topic) {
    return plainFrame(topic.second.front().message->header.frame_id) == frame;
  });
}

bool isBodyOfPoses(const std::string& frame, const Observation& seen) {
  return std::any_of(seen.poses.begin(), seen.poses.end(), [&frame](const auto& topic) {
    return plainFrame(topic.second.front().message->child_frame_id) == frame;
  });
}

/// A cloud in a sensor's frame is more likely than one that was moved into the body or the world.
int likelihoodOfCloud(const std::string& cloud, const Examination& e) {
  const std::string frame = frameOfScans(cloud, e.seen);
  return 4 * static_cast<int>(e.seen.points.at(cloud).unreadable.empty()) +
         2 * static_cast<int>(!isInWorld(frame, e.seen)) +
         static_cast<int>(!isBodyOfPoses(frame, e.seen));
}

/// Where the driver of a device has its topics: what is before ".../depth/image" or ".../points".
std::string deviceOf(const std::string& topic) {
  for (const char* stream : {"/depth", "/aligned_depth", "/stereo"}) {
    const std::size_t begin = topic.find(stream);
    if (begin != std::string::npos) return topic.substr(0, begin);
  }
  return topic.substr(0, topic.rfind('/'));
}

/// One lies below the other.
bool areOneName(const std::string& a, const std::string& b) {
  const std::string &shorter = a.size() < b.size() ? a : b, &longer = a.size() < b.size() ? b : a;
  return !shorter.empty() && (longer + '/').compare(0, shorter.size() + 1, shorter + '/') == 0;
}

bool lookTheSameWay(const Eigen::Isometry3d& T) {
  const double angle = Eigen::AngleAxisd(T.linear()).angle() * 180.0 / M_PI;
  return T.translation().norm() < kSameDevice && std::abs(angle) < kSameView;
}

template <typename Figures>
std::vector<std::string> namesOf(const std::map<std::string, Figures>& topics) {
  std::vector<std::string> names;
  for (const auto& [topic, figures] : topics) names.push_back(topic);
  return names;
}

template <typename Likelihood>
void sortByLikelihood(std::vector<std::string>* topics, const Examination& e,
                      Likelihood likelihood_of) {
  std::stable_sort(topics->begin(), topics->end(), [&](const auto& a, const auto& b) {
    return likelihood_of(a, e) > likelihood_of(b, e);
  });
}

}  // namespace

std::string infoBeside(const std::string& image_topic) {
  return image_topic.substr(0, image_topic.rfind('/') + 1) + "camera_info";
}

std::vector<std::string> depthImages(const Examination& e) {
  std::vector<std::string> topics = namesOf(e.seen.depth);
  sortByLikelihood(&topics, e, likelihood);
  return topics;
}

std::vector<std::string> cloudTopics(const Examination& e) {
  std::vector<std::string> topics = namesOf(e.seen.points);
  sortByLikelihood(&topics, e, likelihoodOfCloud);
  return topics;
}

bool isLikelyDepth(const std::string& depth_image, const Examination& e) {
  return likelihood(depth_image, e) >= kLikelyDepth;
}

bool isOtherImage(const std::string& image, const Examination& e) {
  return e.seen.images.count(image) != 0 && e.seen.depth.count(image) == 0;
}

std::string cameraInfoOf(const std::string& depth_image, const Examination& e) {
  const std::string beside = infoBeside(depth_image);
  if (e.seen.infos.count(beside) != 0) return beside;
  const std::string frame = frameOfScans(depth_image, e.seen);
  const auto of_same_frame =
      std::find_if(e.seen.infos.begin(), e.seen.infos.end(), [&frame](const auto& topic) {
        return plainFrame(topic.second.front().message->header.frame_id) == frame;
      });
  return of_same_frame == e.seen.infos.end() ? "" : of_same_frame->first;
}

bool areOfOneDevice(const std::string& a, const std::string& b, const Examination& e) {
  const std::string frame_a = frameOfScans(a, e.seen), frame_b = frameOfScans(b, e.seen);
  const bool have_frames = !frame_a.empty() && !frame_b.empty();
  if (have_frames && frame_a == frame_b) return true;
  const bool both_clouds = e.seen.clouds.count(a) != 0 && e.seen.clouds.count(b) != 0;
  const bool have_one_name = !both_clouds && areOneName(deviceOf(a), deviceOf(b));
  std::optional<Eigen::Isometry3d> T;
  if (have_frames) T = e.frames.transform(frame_a, frame_b);
  if (!T) return have_one_name;
  // The cloud of a camera may be in another frame of its housing, turned.
  return lookTheSameWay(*T) || (have_one_name && T->translation().norm() < kSameDevice);
}

std::string reasonToLeaveOut(const std::string& scans, const std::vector<ScanTopics>& chosen,
                             const Examination& e) {
  for (const ScanTopics& sensor : chosen) {
    if (areOfOneDevice(scans, sensor.scans(), e))
      return "seems to be of the same device as " + sensor.scans();
  }
  const std::string frame = frameOfScans(scans, e.seen);
  if (e.seen.depth.count(scans) != 0) {
    const bool is_16bit_of_any_kind = e.seen.images.at(scans).front().message->encoding == "mono16";
    if (cameraInfoOf(scans, e).empty()) return "has no camera_info";
    return is_16bit_of_any_kind && !hasWord(scans, "depth") ? "may be no image of depths" : "";
  }
  if (!e.seen.points.at(scans).unreadable.empty()) return "cannot be read";
  if (isInWorld(frame, e.seen)) return "is in the frame of the poses, '" + frame + "'";
  return isBodyOfPoses(frame, e.seen) ? "is in the frame of the body, '" + frame + "'" : "";
}

bool isLidar(const std::string& topic, const Observation& seen) {
  const auto points = seen.points.find(topic);
  return points != seen.points.end() && !points->second.is_organised &&
         quantilesOf(points->second.ranges).p95 > kCameraRange;
}

std::string nameForSensor(const ScanTopics& sensor, const std::vector<ScanTopics>& taken,
                          const Observation& seen) {
  const std::string kind = isLidar(sensor.points, seen) ? "lidar" : "camera";
  std::string name = deviceOf(sensor.scans());
  name = name.substr(name.rfind('/') + 1);
  if (name.empty() && !sensor.points.empty()) {  // "/velodyne_points"
    name = sensor.points.substr(1, sensor.points.find("_points") - 1);
    if (name == "points") name.clear();
  }
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name = kind;
  MapperConfig mapper;
  NodeConfig node;
  std::vector<Parameter> parameters = mapperParameters(&mapper);
  for (const Parameter& parameter : nodeParameters(&node)) parameters.push_back(parameter);
  const auto is_free = [&](const std::string& candidate) {
    const auto has_name = [&candidate](const auto& other) { return other.name == candidate; };
    return std::none_of(taken.begin(), taken.end(), has_name) &&
           std::none_of(parameters.begin(), parameters.end(), has_name);
  };
  if (is_free(name)) return name;
  int number = 2;
  while (!is_free(name + '_' + std::to_string(number))) ++number;
  return name + '_' + std::to_string(number);
}

}  // namespace fiimap
