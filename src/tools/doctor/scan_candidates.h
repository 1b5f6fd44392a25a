#pragma once

#include <string>
#include <vector>

#include "doctor/examination.h"

namespace fiimap {

/// Topics with depth images, the likeliest first.
std::vector<std::string> depthImages(const Examination& examination);
/// Topics with clouds, the likeliest first: one of a sensor before one that was moved elsewhere.
std::vector<std::string> cloudTopics(const Examination& examination);

/// An image of 16 bits may as well be a LiDAR's or a thermal camera's: whether this one has
/// camera_info beside it, or "depth" in its name.
bool isLikelyDepth(const std::string& depth_image, const Examination& examination);

/// Whether the images of a topic are none of depth: of colour, for instance.
bool isOtherImage(const std::string& image, const Examination& examination);

/// Topic of the camera_info beside a depth image, or elsewhere of the same frame; empty: none.
std::string cameraInfoOf(const std::string& depth_image, const Examination& examination);
/// image_transport's rule: beside the image.
std::string infoBeside(const std::string& image_topic);

/// Whether the scans of two topics seem to be of one device: of the same frame; of frames that are
/// close to each other and look the same way; or, where TF does not know, by their names.
bool areOfOneDevice(const std::string& a, const std::string& b, const Examination& examination);

/// Why a topic, next to the sensors that are chosen, is no sensor of its own; empty: it is one.
/// \param scans one of depthImages() or cloudTopics().
std::string reasonToLeaveOut(const std::string& scans, const std::vector<ScanTopics>& chosen,
                             const Examination& examination);

/// A cloud that reaches farther than cameras do, and is no image of points.
bool isLidar(const std::string& points, const Observation& observation);

/// A name for a sensor, from that of its topic; none of those taken and none of a parameter.
std::string nameForSensor(const ScanTopics& sensor, const std::vector<ScanTopics>& taken,
                          const Observation& observation);

}  // namespace fiimap
