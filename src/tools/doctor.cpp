#include <ros/ros.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cstddef>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "doctor/bag_observation.h"
#include "doctor/diagnosis.h"
#include "doctor/live_observation.h"
#include "settings.h"

namespace {

namespace po = boost::program_options;

constexpr int kNothingWrong = 0, kProblems = 1, kCannotLook = 2;  // exit status
constexpr double kLiveSeconds = 5.0, kBagSeconds = 30.0;

constexpr char kUsage[] =
    "Says what keeps fiimap from making a map of a running robot or of a bag, and how to start "
    "it.\n\n"
    "  rosrun fiimap doctor [options]      looks at the graph\n"
    "  rosrun fiimap doctor BAG [options]  looks at a recording\n\n"
    "Exit status: 0 nothing is wrong (but something may be odd), 1 something is, 2 there is no "
    "master, or the bag or an option cannot be used.\n\n";

struct Options {
  std::string bag;
  double seconds = 0.0;  ///< 0: as usual
  double start = 0.0;
  std::vector<std::string> settings;
  fiimap::DoctorWishes wishes;
};

po::options_description describe(Options* options) {
  fiimap::DoctorWishes& wishes = options->wishes;
  const auto topic = [](std::string* name) { return po::value(name)->value_name("TOPIC"); };
  const auto topics = [](std::vector<std::string>* names) {
    return po::value(names)->value_name("TOPIC")->composing();
  };
  po::options_description description("Options");
  description.add_options()("help,h", "this text")(
      "seconds", po::value(&options->seconds)->value_name("S"),
      "how long to look (5 at the graph, 30 at a bag)")(
      "start", po::value(&options->start)->value_name("S"), "where to begin in the bag (0)")(
      "depth-image", topics(&wishes.depth_images), "depth images; again for another camera")(
      "camera-info", topics(&wishes.camera_infos), "their camera_info, in the same order")(
      "points", topics(&wishes.points), "point clouds; alone: instead of depth images")(
      "odom", topic(&wishes.odom), "poses: nav_msgs/Odometry")("pose", topic(&wishes.pose),
                                                               "poses: geometry_msgs/PoseStamped")(
      "transform", topic(&wishes.transform), "poses: geometry_msgs/TransformStamped")(
      "map", po::value(&wishes.map)->value_name("NAME"), "the mapping node that runs")(
      "set", po::value(&options->settings)->value_name("NAME=VALUE")->composing(),
      "a parameter of the map; may be repeated");
  return description;
}

void requireSensible(const Options& options, const po::variables_map& values) {
  if (values.count("seconds") > 0 && !(options.seconds > 0.0)) {
    throw std::invalid_argument("--seconds must be above 0");
  }
  if (!(options.start >= 0.0)) throw std::invalid_argument("--start must be 0 or above");
  const fiimap::DoctorWishes& wishes = options.wishes;
  if (wishes.camera_infos.size() > std::max<std::size_t>(wishes.depth_images.size(), 1)) {
    throw std::invalid_argument("--camera-info is named more often than --depth-image");
  }
  const int poses = static_cast<int>(!wishes.odom.empty()) +
                    static_cast<int>(!wishes.pose.empty()) +
                    static_cast<int>(!wishes.transform.empty());
  if (poses > 1) {
    throw std::invalid_argument("--odom, --pose and --transform exclude each other");
  }
}

/// \return false when help was asked for, and given.
bool parse(int argc, char** argv, Options* options) {
  const po::options_description visible = describe(options);
  po::options_description all;
  all.add(visible).add_options()("bag", po::value(&options->bag));
  po::positional_options_description positions;
  positions.add("bag", 1);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional(positions).run(), values);
  po::notify(values);
  if (values.count("help") > 0) {
    std::cout << kUsage << visible;
    return false;
  }
  requireSensible(*options, values);
  options->wishes.parameters = fiimap::parseSettings(options->settings);
  return true;
}

fiimap::Observation observe(const Options& options) {
  if (!options.bag.empty()) {
    return fiimap::observeBag(options.bag, options.start,
                              options.seconds > 0.0 ? options.seconds : kBagSeconds);
  }
  if (!ros::master::check()) {
    throw std::invalid_argument("no ROS master answers at " + ros::master::getURI() +
                                ": start the robot's launch files or set ROS_MASTER_URI; for a "
                                "recording, name the bag");
  }
  ros::start();
  return fiimap::observeGraph(options.wishes.map,
                              options.seconds > 0.0 ? options.seconds : kLiveSeconds);
}

int run(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, &options)) return kNothingWrong;
  const fiimap::Observation observation = observe(options);
  const fiimap::Diagnosis diagnosis = fiimap::diagnose(observation, options.wishes);
  std::cout << fiimap::toText(diagnosis, observation);
  return diagnosis.count(fiimap::Severity::kError) > 0 ? kProblems : kNothingWrong;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "fiimap_doctor", ros::init_options::AnonymousName);
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return kCannotLook;
  }
}
