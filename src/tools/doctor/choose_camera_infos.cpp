#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "doctor/checks.h"
#include "doctor/scan_candidates.h"
#include "doctor/several_sensors.h"
#include "doctor/topic_choice.h"

namespace fiimap {
namespace {

/// The camera_info that the user named for a depth image: the one in its place, or alone that of
/// the only image. Empty: none.
std::string namedInfo(const std::string& image, const DoctorWishes& wishes) {
  const std::vector<std::string>& images = wishes.depth_images;
  const auto place = std::find(images.begin(), images.end(), image) - images.begin();
  const auto index = static_cast<std::size_t>(place);
  return index < wishes.camera_infos.size() ? wishes.camera_infos[index] : "";
}

/// The camera_info that the map that runs listens to. Empty: none, or unknown.
std::string listenedInfo(std::size_t sensor, const Examination& e) {
  const MapSetup& setup = e.setup;
  return setup.sensors.empty()
             ? listenedTo(kCameraInfoType, e.seen, {infoBeside(setup.depth_image)})
             : listenedBy(setup.node.sensors[sensor], e.seen).camera_info;
}

/// Which one is taken, with a word where that may surprise.
std::string chooseInfo(const std::string& image, const std::string& listened, Examination* e) {
  const auto comes = [e](const std::string& topic) { return e->seen.infos.count(topic) != 0; };
  const std::string named = namedInfo(image, e->wishes);
  if (comes(named)) return named;
  const std::string chosen = comes(listened) ? listened : cameraInfoOf(image, *e);
  if (!named.empty()) {
    e->warn("No message came on " + named + ", the camera_info that is named for " + image +
                (chosen.empty() ? "." : "; that of " + chosen + " is taken."),
            "Look at its publisher, or name another: --camera-info TOPIC.");
  } else if (!chosen.empty() && chosen != listened && chosen != infoBeside(image)) {
    e->note("The camera_info of " + image + " is not beside it, but on " + chosen +
            " there is one of the same frame.");
  }
  return chosen;
}

void requireNamedInfos(const std::vector<std::string>& images, Examination* e) {
  const DoctorWishes& wishes = e->wishes;
  for (const std::string& topic : wishes.camera_infos) {
    requireType(topic, {kCameraInfoType}, "--camera-info", e->seen);
  }
  if (wishes.camera_infos.empty() || !wishes.depth_images.empty() || images.size() == 1) return;
  const std::string option = "--camera-info " + wishes.camera_infos.front();
  if (images.empty()) {
    e->warn(option + " is of no use: no depth image is looked at.",
            "Name its depth image, too: --depth-image TOPIC.");
    return;
  }
  throw std::invalid_argument(option + ": of which depth image? There are " + listOf(images) +
                              "; name --depth-image TOPIC --camera-info TOPIC for each camera, and "
                              "--points TOPIC for each LiDAR");
}

}  // namespace

void chooseCameraInfos(Examination* e) {
  std::vector<ScanTopics> sensors = e->setup.allSensors();
  std::vector<std::string> images;
  for (const ScanTopics& sensor : sensors) {
    if (!sensor.depth_image.empty()) images.push_back(sensor.depth_image);
  }
  requireNamedInfos(images, e);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string& image = sensors[i].depth_image;
    if (e->seen.images.count(image) == 0) continue;
    sensors[i].camera_info = chooseInfo(image, listenedInfo(i, *e), e);
  }
  if (e->setup.sensors.empty()) {
    e->setup.camera_info = sensors.front().camera_info;
  } else {
    e->setup.setSensors(sensors);
  }
}

}  // namespace fiimap
