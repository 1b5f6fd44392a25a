#pragma once

#include <string>
#include <vector>

#include "doctor/frame_graph.h"
#include "doctor/observation.h"
#include "doctor/trial.h"
#include "fiimap/mapper_config.h"
#include "fiimap/parameters.h"
#include "fiimap/ros/node_config.h"

namespace fiimap {

enum class Severity {
  kNote,     ///< what was chosen or set, and why
  kWarning,  ///< odd, but it may be meant
  kError,    ///< there would be no map, or a wrong one
};

/// Whether the launch line takes care of an error. Those before ask for more than those after.
enum class Repair {
  kNone,
  kInLaunchLine,  ///< by what it sets
  kLeftOut,       ///< by doing without the sensor
};

struct Finding {
  Severity severity = Severity::kNote;
  std::string what;    ///< sentences with the figures
  std::string remedy;  ///< a sentence; empty where there is nothing to do
  Repair repair = Repair::kNone;
  std::string command{};  ///< of the remedy, to be typed; empty where there is none
};

/// What the user chose where there is a choice. Empty: found by type.
struct DoctorWishes {
  std::vector<std::string> depth_images, points;  ///< topics; more than one: several sensors
  std::vector<std::string> camera_infos;          ///< topics, in the order of the depth images
  std::string odom, pose, transform;              // topics; at most one
  std::string map;                                ///< name of the mapping node
  ParameterMap parameters;                        ///< of the map
};

/// The topics of a sensor: a depth image with its camera_info, or points.
struct ScanTopics {
  std::string name;         ///< of one of several sensors; empty: it needs none
  std::string depth_image;  ///< topic; empty: none
  std::string camera_info;  ///< topic, with messages; empty: none
  std::string points;       ///< topic; empty: none

  const std::string& scans() const { return depth_image.empty() ? points : depth_image; }
};

/// The inputs that were found and the parameters that fit them. Of several sensors, the topics are
/// those of the one that is looked at, or the first.
struct MapSetup : ScanTopics {
  std::vector<ScanTopics> sensors;    ///< in the order of node.sensors; empty: one without a name
  std::vector<std::string> left_out;  ///< names of sensors that the launch line does without
  std::string poses;                  ///< topic; empty: none, or TF
  bool has_poses = false;             ///< a topic, or TF
  MapperConfig mapper;
  NodeConfig node;
  ParameterMap changes;  ///< parameters beside topics, sensor, pose_source and map_frame to be set

  /// All sensors, at least one.
  std::vector<ScanTopics> allSensors() const;
  /// Several sensors, and with them the topics of the first.
  void setSensors(const std::vector<ScanTopics>& several);
};

/// An observation on its way through the checks. Each takes the setup as those before it left it,
/// says what it finds, and changes the setup where that helps.
struct Examination {
  /// \throws std::invalid_argument when a parameter that the user chose is not allowed.
  Examination(const Observation& observation, const DoctorWishes& wishes);

  const Observation& seen;
  DoctorWishes wishes;
  FrameGraph frames;
  MapSetup setup;
  ParameterMap given;  ///< parameters of the user or of the node that runs: not open
  std::vector<Finding> findings;
  std::vector<Trial> trials;  ///< of each of setup.allSensors(); empty until checkSensors()

  bool isGiven(const std::string& parameter) const { return given.count(parameter) != 0; }
  void note(const std::string& what, const std::string& remedy = "");
  void warn(const std::string& what, const std::string& remedy);
  void error(const std::string& what, const std::string& remedy, Repair repair = Repair::kNone,
             const std::string& command = "");
  /// Sets a parameter of the map that the launch line must then set.
  void change(const std::string& parameter, const std::string& value);

  /// Frame of the scans; there must be some.
  std::string sensorFrame() const;
  /// Scans were chosen, and some came.
  bool hasScans() const;
  /// Frames of the scans of all sensors of which some came.
  std::vector<std::string> sensorFrames() const;
};

/// Frame of the scans that came on a topic; empty where none came.
std::string frameOfScans(const std::string& topic, const Observation& observation);

/// "2.0 Hz", "0.25 s", "37 %": numbers as sentences want them.
std::string withUnit(double value, const char* unit, int digits = 2);
/// With at most 6 decimals and no exponent, which YAML would take for text: "0.0001", "2", "-0.5".
std::string plainNumber(double value);
std::string percent(double share);
/// "a, b, c".
std::string listOf(const std::vector<std::string>& names);

}  // namespace fiimap
