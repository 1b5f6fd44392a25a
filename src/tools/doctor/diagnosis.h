#pragma once

#include <string>
#include <vector>

#include "doctor/examination.h"
#include "doctor/trial.h"
#include "health/topic_health.h"

namespace fiimap {

/// What is wrong or odd with the inputs of a map, and how to start one.
struct Diagnosis {
  std::vector<Finding> findings;    ///< errors first
  std::vector<TopicHealth> topics;  ///< of scans, camera_info and poses that were chosen
  MapSetup setup;
  Trial trial;                ///< of all sensors
  std::vector<Trial> trials;  ///< of each of setup.allSensors()
  /// Empty where no line would lead to a map, or the map that runs needs no other.
  std::vector<std::string> launch_words;
  std::vector<std::string> kept;  ///< parameters that the map that runs has set, and the line keeps

  std::size_t count(Severity severity) const;
};

/// \throws std::invalid_argument when a wish names no such topic or no such parameter, or wishes
/// contradict each other.
Diagnosis diagnose(const Observation& observation, const DoctorWishes& wishes);

/// For people.
std::string toText(const Diagnosis& diagnosis, const Observation& observation);

}  // namespace fiimap
