#include <algorithm>
#include <stdexcept>

#include "doctor/checks.h"
#include "doctor/topic_choice.h"
#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

const std::string kImageType = "sensor_msgs/Image";
const std::string kCompressedType = "sensor_msgs/CompressedImage";
const std::string kInfoType = "sensor_msgs/CameraInfo";
const std::string kCloudType = "sensor_msgs/PointCloud2";

/// image_transport's rule: beside the image.
std::string infoBeside(const std::string& image_topic) {
  return image_topic.substr(0, image_topic.rfind('/') + 1) + "camera_info";
}

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

/// Below it, an image of 16 bits may as well be a LiDAR's or a thermal camera's.
constexpr int kLikelyDepth = 2;

int likelihood(const std::string& depth_image, const Examination& e) {
  return 4 * static_cast<int>(e.seen.infos.count(infoBeside(depth_image))) +
         2 * static_cast<int>(contains(depth_image, "depth")) +
         static_cast<int>(contains(depth_image, "rect"));
}

/// A cloud in a sensor's frame is more likely than one that was moved into the world.
int likelihoodOfCloud(const std::string& cloud, const Examination& e) {
  const std::string frame = plainFrame(e.seen.clouds.at(cloud).front().message->header.frame_id);
  const bool is_in_world =
      std::any_of(e.seen.poses.begin(), e.seen.poses.end(), [&frame](const auto& topic) {
        return plainFrame(topic.second.front().message->header.frame_id) == frame;
      });
  return 2 * static_cast<int>(e.seen.points.at(cloud).unreadable.empty()) +
         static_cast<int>(!is_in_world);
}

std::vector<std::string> depthImages(const Examination& e) {
  std::vector<std::string> topics;
  for (const auto& [topic, figures] : e.seen.depth) topics.push_back(topic);
  std::stable_sort(topics.begin(), topics.end(), [&e](const auto& a, const auto& b) {
    return likelihood(a, e) > likelihood(b, e);
  });
  return topics;
}

std::vector<std::string> cloudTopics(const Examination& e) {
  std::vector<std::string> topics;
  for (const auto& [topic, figures] : e.seen.points) topics.push_back(topic);
  std::stable_sort(topics.begin(), topics.end(), [&e](const auto& a, const auto& b) {
    return likelihoodOfCloud(a, e) > likelihoodOfCloud(b, e);
  });
  return topics;
}

/// The images that came and are none, and those of which nothing came.
std::string otherImages(const Examination& e) {
  std::vector<std::string> others;
  for (const std::string& topic : topicsOfType(kImageType, e.seen)) {
    const auto images = e.seen.images.find(topic);
    if (images == e.seen.images.end()) {
      others.push_back(topic + " (silent)");
    } else if (e.seen.depth.count(topic) == 0) {
      others.push_back(topic + " (" + images->second.front().message->encoding + ")");
    }
  }
  return listOf(others);
}

std::string compressedDepth(const Examination& e) {
  for (const std::string& topic : topicsOfType(kCompressedType, e.seen)) {
    if (contains(topic, "compressedDepth")) return topic;
  }
  return "";
}

void reportNoScans(Examination* e) {
  const std::string compressed = compressedDepth(*e);
  if (!compressed.empty()) {
    const std::string base = compressed.substr(0, compressed.rfind('/'));
    e->error("There are depth images in compressed form only: " + compressed + ".",
             "Unpack them: rosrun image_transport republish compressedDepth in:=" + base +
                 " raw out:=" + base + "_unpacked");
    return;
  }
  const std::string others = otherImages(*e);
  std::vector<std::string> silent;
  for (const std::string& cloud : topicsOfType(kCloudType, e->seen)) {
    if (!isOutputOfMap(cloud, e->seen)) silent.push_back(cloud + " (silent)");
  }
  const std::string clouds = listOf(silent);
  e->error("There are no depth images (16UC1, mono16 or 32FC1) and no point clouds; images: " +
               (others.empty() ? "none" : others) +
               "; clouds: " + (clouds.empty() ? "none" : clouds) + ".",
           "Start the depth camera or LiDAR with its depth stream switched on; a colour image is "
           "no depth image.");
}

/// The topic that the user, or the node that runs, wants.
std::string wanted(const std::string& wish, const std::string& type, const char* option,
                   const std::vector<std::string>& candidates, const Examination& e) {
  if (wish.empty()) return listenedTo(type, e.seen, candidates);
  requireType(wish, {type}, option, e.seen);
  return wish;
}

void chooseCameraInfo(Examination* e) {
  const std::string beside = infoBeside(e->setup.depth_image);
  const std::string wish = wanted(e->wishes.camera_info, kInfoType, "--camera-info", {beside}, *e);
  if (e->seen.infos.count(wish) != 0) {
    e->setup.camera_info = wish;
    return;
  }
  if (e->seen.infos.count(beside) != 0) {
    e->setup.camera_info = beside;
    return;
  }
  // Elsewhere: that of the same frame.
  for (const auto& [topic, infos] : e->seen.infos) {
    if (plainFrame(infos.front().message->header.frame_id) != e->sensorFrame()) continue;
    e->setup.camera_info = topic;
    e->note("The camera_info of " + e->setup.depth_image + " is not beside it, but on " + topic +
            " there is one of the same frame.");
    return;
  }
}

void useDepth(const std::string& topic, const std::vector<std::string>& all, Examination* e) {
  e->setup.depth_image = topic;
  e->setup.node.sensor = SensorKind::kDepth;
  noteOthers("depth images", topic, all, "--depth-image", e);
  if (e->hasScans()) chooseCameraInfo(e);
}

void usePoints(const std::string& topic, const std::vector<std::string>& all, Examination* e) {
  e->setup.points = topic;
  e->setup.node.sensor = SensorKind::kPoints;
  noteOthers("clouds", topic, all, "--points", e);
}

}  // namespace

void chooseScans(Examination* e) {
  const std::vector<std::string> images = depthImages(*e), clouds = cloudTopics(*e);
  const bool map_takes_points = e->seen.map && e->setup.node.sensor == SensorKind::kPoints;
  const bool points_named = !e->wishes.points.empty();
  std::string image = points_named || (map_takes_points && e->wishes.depth_image.empty())
                          ? ""
                          : wanted(e->wishes.depth_image, kImageType, "--depth-image", images, *e);
  std::string cloud = wanted(e->wishes.points, kCloudType, "--points", clouds, *e);
  if (!image.empty() && e->seen.images.count(image) != 0 && e->seen.depth.count(image) == 0) {
    e->error("The image " + image + " has the encoding '" +
                 e->seen.images.at(image).front().message->encoding + "': it is no depth image.",
             "Use one of encoding 16UC1, mono16 or 32FC1" +
                 (images.empty() ? "." : ": " + listOf(images) + "."));
    return;
  }
  // What a map listens to in vain is said with the map.
  if (e->seen.depth.count(image) == 0 && e->wishes.depth_image.empty()) image.clear();
  if (e->seen.points.count(cloud) == 0 && e->wishes.points.empty()) cloud.clear();
  const bool images_are_likely =
      !images.empty() && (clouds.empty() || likelihood(images.front(), *e) >= kLikelyDepth);
  if (image.empty() && !points_named && !map_takes_points && images_are_likely) {
    image = images.front();
  }
  if (!image.empty()) {
    useDepth(image, images, e);
    if (!clouds.empty()) {
      e->note("There are clouds too: " + listOf(clouds) + ".",
              "For a map of clouds add --points TOPIC.");
    }
  } else if (!cloud.empty() || !clouds.empty()) {
    usePoints(cloud.empty() ? clouds.front() : cloud, clouds, e);
  } else {
    reportNoScans(e);
    return;
  }
  if (!e->hasScans()) {
    e->error("No message came on " + e->setup.scans() + " in " + withUnit(e->seen.seconds, "s", 1) +
                 ", although it is advertised.",
             "Look at its publisher; a driver may wait for its device, or publish nothing until "
             "its stream is switched on.");
  }
}

}  // namespace fiimap
