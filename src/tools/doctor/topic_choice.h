#pragma once

#include <string>
#include <vector>

#include "doctor/examination.h"

namespace fiimap {

constexpr char kImageType[] = "sensor_msgs/Image";
constexpr char kCameraInfoType[] = "sensor_msgs/CameraInfo";
constexpr char kCloudType[] = "sensor_msgs/PointCloud2";

/// All topics of a message type, in the order of their names.
std::vector<std::string> topicsOfType(const std::string& type, const Observation& observation);

/// The topic of a type that the mapping node that runs listens to, one of the candidates if it can
/// be: in a nodelet manager, what others listen to is among its inputs. Empty where there is none.
std::string listenedTo(const std::string& type, const Observation& observation,
                       const std::vector<std::string>& candidates);

/// \param option that names the topic.
/// \throws std::invalid_argument unless the topic exists and is of one of the types.
void requireType(const std::string& topic, const std::vector<std::string>& types,
                 const std::string& option, const Observation& observation);

/// Says that a topic was chosen among several.
/// \param option that chooses another.
void noteOthers(const std::string& what, const std::string& chosen,
                const std::vector<std::string>& all, const std::string& option,
                Examination* examination);

}  // namespace fiimap
