#include <algorithm>
#include <stdexcept>

#include "doctor/checks.h"
#include "doctor/scan_candidates.h"
#include "doctor/several_sensors.h"
#include "doctor/topic_choice.h"

namespace fiimap {
namespace {

const std::string kCompressedType = "sensor_msgs/CompressedImage";

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
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

std::string firstWish(const std::vector<std::string>& wishes) {
  return wishes.empty() ? "" : wishes.front();
}

/// The topic that the user, or the node that runs, wants.
std::string wanted(const std::string& wish, const std::string& type,
                   const std::vector<std::string>& candidates, const Examination& e) {
  return wish.empty() ? listenedTo(type, e.seen, candidates) : wish;
}

/// Depth images or clouds: the first sensor, or the only one.
void chooseFirst(Examination* e) {
  const std::vector<std::string> images = depthImages(*e), clouds = cloudTopics(*e);
  const std::string image_wish = firstWish(e->wishes.depth_images);
  const std::string cloud_wish = firstWish(e->wishes.points);
  const bool map_takes_points = e->seen.map && e->setup.node.sensor == SensorKind::kPoints;
  const bool points_named = !cloud_wish.empty();
  std::string image = points_named || (map_takes_points && image_wish.empty())
                          ? ""
                          : wanted(image_wish, kImageType, images, *e);
  std::string cloud = wanted(cloud_wish, kCloudType, clouds, *e);
  // What a map listens to in vain is said with the map.
  if (e->seen.images.count(image) == 0 && image_wish.empty()) image.clear();
  if (e->seen.points.count(cloud) == 0 && cloud_wish.empty()) cloud.clear();
  const bool images_are_likely =
      !images.empty() && (clouds.empty() || isLikelyDepth(images.front(), *e));
  if (image.empty() && !points_named && !map_takes_points && images_are_likely) {
    image = images.front();
  }
  if (!image.empty()) {
    e->setup.depth_image = image;
  } else if (!cloud.empty() || !clouds.empty()) {
    e->setup.points = cloud.empty() ? clouds.front() : cloud;
  }
}

/// Says which topics beside the only sensor there are.
void noteOthersOfOne(Examination* e) {
  const MapSetup& setup = e->setup;
  const std::vector<std::string> clouds = cloudTopics(*e);
  if (setup.depth_image.empty()) {
    noteOthers("clouds", setup.points, clouds, "--points", e);
    return;
  }
  noteOthers("depth images", setup.depth_image, depthImages(*e), "--depth-image", e);
  if (clouds.empty()) return;
  e->note("There are clouds too: " + listOf(clouds) + ".",
          "For a map of clouds add --points TOPIC.");
}

void useOne(Examination* e) {
  if (!isOtherImage(e->setup.depth_image, *e)) noteOthersOfOne(e);
  const bool has_depth = !e->setup.depth_image.empty();
  e->setup.node.sensor = has_depth ? SensorKind::kDepth : SensorKind::kPoints;
}

/// Whether the user, or the map that runs, has one sensor.
bool isOneWanted(const Examination& e) {
  return e.seen.map || e.wishes.depth_images.size() + e.wishes.points.size() == 1;
}

void requireTopics(const std::vector<std::string>& topics, const std::string& type,
                   const std::string& option, const Observation& seen) {
  for (const std::string& topic : topics) {
    requireType(topic, {type}, option, seen);
    if (std::count(topics.begin(), topics.end(), topic) == 1) continue;
    throw std::invalid_argument(option + ' ' + topic + " is named twice");
  }
}

/// \throws std::invalid_argument unless the scans that the user named can be those of one map.
void requireNamedScans(const Examination& e) {
  const DoctorWishes& wishes = e.wishes;
  requireTopics(wishes.depth_images, kImageType, "--depth-image", e.seen);
  requireTopics(wishes.points, kCloudType, "--points", e.seen);
  const std::size_t count = wishes.depth_images.size() + wishes.points.size();
  if (count <= NodeConfig::kMaxSensors) return;
  throw std::invalid_argument("--depth-image and --points name " + std::to_string(count) +
                              " sensors; a map has at most " +
                              std::to_string(NodeConfig::kMaxSensors));
}

}  // namespace

void chooseScans(Examination* e) {
  requireNamedScans(*e);
  if (chooseNamedSensors(e)) return;
  chooseFirst(e);
  if (e->setup.scans().empty()) {
    reportNoScans(e);
  } else if (isOneWanted(*e) || !chooseAllSensors(e)) {
    useOne(e);
  }
}

void checkScansCome(Examination* e) {
  const bool is_named = !e->setup.name.empty();
  if ((e->setup.scans().empty() && !is_named) || e->hasScans()) return;
  if (e->setup.scans().empty()) {
    const bool has_depth = e->setup.node.sensor == SensorKind::kDepth;
    e->error(std::string("There are no ") + (has_depth ? "depth images" : "clouds") +
                 " for the sensor '" + e->setup.name + "'.",
             std::string("Start it, or name its topic: ") +
                 (has_depth ? "--depth-image" : "--points") + " TOPIC for each sensor.");
    return;
  }
  e->error("No message came on " + e->setup.scans() + " in " + withUnit(e->seen.seconds, "s", 1) +
               (e->seen.types.count(e->setup.scans()) != 0 ? ", although it is advertised."
                                                           : ": nobody publishes it."),
           "Look at its publisher; a driver may wait for its device, or publish nothing until "
           "its stream is switched on.");
}

}  // namespace fiimap
