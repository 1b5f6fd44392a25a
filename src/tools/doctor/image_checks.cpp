#include <algorithm>

#include "doctor/checks.h"
#include "doctor/scan_candidates.h"
#include "doctor/topic_choice.h"
#include "fiimap/ros/drop_reason.h"
#include "fiimap/ros/frame_id.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap {
namespace {

constexpr double kFewReadings = 0.05;  // of the pixels
// Depth cameras that fly see from some decimetres to some tens of metres.
constexpr double kFarMedian = 20.0;  // m
constexpr double kNearP95 = 0.1;     // m
// In the order in which they are usual: mm; 0.1 mm; 0.25 mm (time of flight); cm; m.
constexpr double kScales[] = {0.001, 0.0001, 0.00025, 0.01, 1.0};  // m per unit
constexpr double kLeastPlausible = 0.3, kMostPlausible = 15.0;     // m, of a median

std::string candidates(const Examination& e) {
  std::vector<std::string> names;
  for (const auto& [topic, infos] : e.seen.infos) {
    const sensor_msgs::CameraInfo& info = *infos.front().message;
    names.push_back(topic + " (" + std::to_string(info.width) + " x " +
                    std::to_string(info.height) + ", frame '" + info.header.frame_id + "')");
  }
  for (const std::string& topic : topicsOfType(kCameraInfoType, e.seen)) {
    if (e.seen.infos.count(topic) == 0) names.push_back(topic + " (silent)");
  }
  return listOf(names);
}

/// The most usual scale that makes a median plausible; empty where none does.
std::string plausibleScale(double median) {
  for (const double scale : kScales) {
    const double metres = median * scale;
    if (metres >= kLeastPlausible && metres <= kMostPlausible) return plainNumber(scale);
  }
  return "";
}

void reportUnit(const DepthFigures& figures, const Quantiles& raw, double scale, Examination* e) {
  const std::string& topic = e->setup.depth_image;
  const std::string in_metres = "median " + withUnit(raw.median * scale, "m") + ", 95 % below " +
                                withUnit(raw.p95 * scale, "m");
  if (!figures.is_16bit) {
    e->error("Depth of " + topic +
                 " is in the wrong unit: 32-bit images are in metres, and it "
                 "reads " +
                 in_metres + (raw.median > kFarMedian ? "; these look like millimetres." : "."),
             "Let the driver publish metres, or 16-bit millimetres (16UC1, which depth_scale can "
             "adjust).");
    return;
  }
  const std::string suggestion = plausibleScale(raw.median);
  const std::string what = "Depth of " + topic + " is probably in another unit than depth_scale " +
                           "says: its values, median " + withUnit(raw.median, "units", 0) +
                           ", would mean " + in_metres + ".";
  if (suggestion.empty()) {
    e->error(what, "Set depth_scale to the metres per unit of the driver.");
    return;
  }
  e->error(what,
           "Set depth_scale: " + suggestion + " (then the median is " +
               withUnit(raw.median * std::stod(suggestion), "m") +
               ") if the driver's depth unit is that; cameras differ: 0.001, 0.00025, 0.0001 m.",
           Repair::kInLaunchLine);
  e->change("depth_scale", suggestion);
}

}  // namespace

bool checkEncoding(Examination* e) {
  const std::string& topic = e->setup.depth_image;
  if (!isOtherImage(topic, *e)) return true;
  const std::vector<std::string> images = depthImages(*e);
  e->error("The image " + topic + " has the encoding '" +
               e->seen.images.at(topic).front().message->encoding + "': it is no depth image.",
           "Use one of encoding 16UC1, mono16 or 32FC1" +
               (images.empty() ? "." : ": " + listOf(images) + "."));
  return false;
}

void checkCameraInfo(Examination* e) {
  const std::string& image_topic = e->setup.depth_image;
  if (image_topic.empty() || !e->hasScans()) return;
  const std::string& topic = e->setup.camera_info;
  if (topic.empty()) {
    const std::string others = candidates(*e);
    e->error(
        "The depth image " + image_topic + " has no camera_info beside it" +
            (others.empty() ? ", and there is none elsewhere." : "; elsewhere: " + others + "."),
        others.empty() ? "Publish sensor_msgs/CameraInfo of the depth camera; without its "
                         "focal length there is no map."
                       : "If one of these belongs to the depth image, choose it with "
                         "--camera-info TOPIC; else publish that of the depth camera.");
    return;
  }
  const sensor_msgs::Image& image = *e->seen.images.at(image_topic).back().message;
  const sensor_msgs::CameraInfo& info = *e->seen.infos.at(topic).back().message;
  try {
    decodeCameraInfo(info, image.width, image.height);
  } catch (const InputError& error) {
    e->error(
        "The camera_info " + topic + " does not fit " + image_topic + ": " + error.what() + ".",
        "Use the camera_info that belongs to this image (there are: " + candidates(*e) +
            "), or calibrate the camera.");
  }
  const std::string frame = plainFrame(info.header.frame_id), of_image = e->sensorFrame();
  if (frame != of_image) {
    e->warn(
        "The camera_info " + topic + " is of frame '" + frame + "', the depth image of '" +
            of_image + "': it may be another camera's.",
        "Choose the depth camera's with --camera-info TOPIC (there are: " + candidates(*e) + ").");
  }
}

void checkDepthReadings(Examination* e) {
  const auto found = e->seen.depth.find(e->setup.depth_image);
  if (found == e->seen.depth.end()) return;
  const auto& [topic, figures] = *found;
  if (!figures.unreadable.empty()) {
    e->error("Depth images of " + topic + " cannot be read: " + figures.unreadable + ".",
             remedyFor(DropReason::kBadImage) + ".");
  }
  if (figures.pixels == 0) return;
  const auto share = [&figures = figures](std::size_t part) {
    return percent(static_cast<double>(part) / static_cast<double>(figures.pixels));
  };
  const std::string others = share(figures.zero) + " are 0, " + share(figures.not_a_number) +
                             " NaN, " + share(figures.infinite) + " infinite, " +
                             share(figures.saturated) + " 65535";
  if (figures.readings.empty()) {
    // Infinity means that the ray is free: in an empty sky that is a map.
    if (figures.infinite > 0) {
      e->warn("No pixel of " + topic + " met anything: " + others + ".",
              "Let the camera look at something nearer than its range.");
    } else {
      e->error("No pixel of " + topic + " has a depth: " + others + ".",
               "Look at the camera: is its lens covered, its projector off, is everything nearer "
               "than its minimum range, are exposure and depth stream set up?");
    }
    return;
  }
  if (figures.readingShare() < kFewReadings) {
    e->warn("Only " + percent(figures.readingShare()) + " of the pixels of " + topic +
                " have a depth: " + others + ".",
            "Look at the camera: light, texture, exposure, distance.");
  }
  const double scale = figures.is_16bit ? e->setup.mapper.depth_scale : 1.0;
  const Quantiles raw = quantilesOf(figures.readings);
  if (raw.median * scale > kFarMedian || raw.p95 * scale < kNearP95) {
    reportUnit(figures, raw, scale, e);
  }
}

}  // namespace fiimap
