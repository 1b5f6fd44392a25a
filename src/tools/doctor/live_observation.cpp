#include "doctor/live_observation.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <fiimap/MapInfo.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <functional>
#include <set>
#include <stdexcept>

#include "doctor/examination.h"
#include "fiimap/ros/message_conversions.h"
#include "fiimap/ros/parameter_sources.h"
#include "fiimap/ros/pose_messages.h"

namespace fiimap {
namespace {

constexpr int kQueue = 1000;            // messages
constexpr int kScanQueue = 30;          // scans: they are large
const ros::WallDuration kRefresh(0.5);  // between looks for new topics
const ros::WallDuration kPause(0.002);  // between looks for new messages
const std::string kDiagnostics = "/diagnostics";

/// Simulated time where there is one: by it messages are stamped.
ros::Time now() {
  const ros::Time simulated = ros::Time::now();
  if (!simulated.isZero()) return simulated;
  const ros::WallTime wall = ros::WallTime::now();
  return {wall.sec, wall.nsec};
}

/// Subscribes as topics appear. Callbacks run in the thread that calls spin().
class GraphListener {
 public:
  GraphListener(std::string map, Observation* observation)
      : map_(std::move(map)), observation_(observation) {}

  void listen(double seconds) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    ros::WallTime refreshed;
    while (ros::ok() && ros::WallTime::now() < end) {
      if (ros::WallTime::now() - refreshed > kRefresh) {
        refresh();
        refreshed = ros::WallTime::now();
      }
      ros::spinOnce();
      kPause.sleep();
    }
    describeMap();
    subscribers_.clear();
    handles_.clear();
  }

 private:
  template <typename Message>
  using Callback = boost::function<void(const boost::shared_ptr<const Message>&)>;

  void refresh() {
    ros::master::V_TopicInfo topics;
    ros::master::getTopics(topics);
    for (const ros::master::TopicInfo& topic : topics) {
      observation_->types[topic.name] = topic.datatype;
    }
    for (const std::string& map : mapsIn(observation_->types)) {
      if (handles_.count(map) != 0) continue;
      const Callback<MapInfo> nothing = [](const MapInfo::ConstPtr&) {};
      handles_[map] = node_.subscribe<MapInfo>(map + "/map_handle", kQueue, nothing);
    }
    for (const ros::master::TopicInfo& topic : topics) subscribe(topic.name, topic.datatype);
    subscribe(kDiagnostics,
              ros::message_traits::DataType<diagnostic_msgs::DiagnosticArray>::value());
  }

  void subscribe(const std::string& topic, const std::string& type) {
    if (subscribers_.count(topic) != 0 || isOutputOfMap(topic, *observation_)) return;
    subscribeAs<sensor_msgs::Image>(
        topic, type,
        [this, topic](const auto& image) {
          observe(topic, image, now(), observation_);
          // One tells that it is no depth image; no need to move more of them.
          if (!isDepthEncoding(image->encoding)) subscribers_.at(topic).shutdown();
        },
        kScanQueue);
    const auto plainly = [this, topic](const auto& message) {
      observe(topic, message, now(), observation_);
    };
    subscribeAs<sensor_msgs::CameraInfo>(topic, type, plainly);
    subscribeAs<sensor_msgs::PointCloud2>(topic, type, plainly, kScanQueue);
    subscribeAs<tf2_msgs::TFMessage>(topic, type, plainly);
    const auto as_transform = [this, topic](const auto& pose) {
      observe(topic, toTransform(*pose), now(), observation_);
    };
    subscribeAs<nav_msgs::Odometry>(topic, type, as_transform);
    subscribeAs<geometry_msgs::PoseStamped>(topic, type, as_transform);
    subscribeAs<geometry_msgs::TransformStamped>(topic, type, [this, topic](const auto& pose) {
      observe(topic, *pose, now(), observation_);
    });
    subscribeAs<rosgraph_msgs::Clock>(
        topic, type, [this](const auto& /*clock*/) { ++observation_->clock_messages; });
    subscribeAs<diagnostic_msgs::DiagnosticArray>(
        topic, type, [this](const auto& message) { onDiagnostics(*message); });
  }

  template <typename Message, typename Call>
  void subscribeAs(const std::string& topic, const std::string& type, Call call,
                   int queue = kQueue) {
    if (type != ros::message_traits::DataType<Message>::value()) return;
    const Callback<Message> callback = call;
    subscribers_[topic] = node_.subscribe<Message>(topic, queue, callback);
  }

  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
    for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
      statuses_[status.name] = status;
    }
  }

  /// The map that was asked for, or the first that lives: a master also names those that died.
  void describeMap() {
    for (const auto& [name, handle] : handles_) {
      const bool is_wanted = map_.empty() || ros::names::resolve(map_) == name;
      if (!is_wanted || handle.getNumPublishers() == 0) continue;
      observation_->map = RunningMap();
      observation_->map->name = name;
      observation_->map->parameters = parameterMapFromRos(ros::NodeHandle(name));
      describeInputs(&*observation_->map);
      addSensors(&*observation_->map);
      addTroubles(&*observation_->map);
      return;
    }
  }

  void addTroubles(RunningMap* map) const {
    const std::string prefix = map->name.substr(1) + ": ";
    for (const auto& [name, status] : statuses_) {
      const bool is_start = status.values.empty();  // the updater's own first word
      const bool is_ok = status.level == diagnostic_msgs::DiagnosticStatus::OK;
      if (name.compare(0, prefix.size(), prefix) != 0 || is_start || is_ok) continue;
      const bool is_error = status.level != diagnostic_msgs::DiagnosticStatus::WARN;
      (is_error ? map->errors : map->warnings).push_back(status.message);
    }
  }

  /// What each sensor listens to, from the status of the map's inputs: "front: scan topic".
  void addSensors(RunningMap* map) const {
    const auto status = statuses_.find(map->name.substr(1) + ": inputs");
    if (status == statuses_.end()) return;
    for (const diagnostic_msgs::KeyValue& value : status->second.values) {
      const std::size_t colon = value.key.find(": ");
      if (colon == std::string::npos) continue;
      const std::string sensor = value.key.substr(0, colon), what = value.key.substr(colon + 2);
      if (what == "scan topic") map->sensors[sensor].scans = value.value;
      if (what == "camera_info topic") map->sensors[sensor].camera_info = value.value;
    }
  }

  /// Topics that the process of a map listens to, with their types, and whether it is a manager.
  static void describeInputs(RunningMap* map) {
    XmlRpc::XmlRpcValue arguments, response, state, types;
    arguments[0] = ros::this_node::getName();
    const bool wait = false;
    if (!ros::master::execute("getSystemState", arguments, response, state, wait) ||
        !ros::master::execute("getTopicTypes", arguments, response, types, wait)) {
      return;
    }
    std::map<std::string, std::string> type_of;
    for (int i = 0; i < types.size(); ++i) {
      type_of[static_cast<std::string>(types[i][0])] = static_cast<std::string>(types[i][1]);
    }
    std::set<std::string> processes;
    forEachUser(state[0], [&](const std::string& topic, const std::string& node) {
      if (topic == map->name + "/map_handle") processes.insert(node);
    });
    forEachUser(state[1], [&](const std::string& topic, const std::string& node) {
      if (processes.count(node) != 0) map->inputs[topic] = type_of[topic];
    });
    forEachUser(state[2], [&](const std::string& service, const std::string& node) {
      if (processes.count(node) != 0 && service == node + "/load_nodelet") map->manager = node;
    });
  }

  /// \param users of the master's state: [[topic, [node, ...]], ...].
  template <typename Visit>
  static void forEachUser(XmlRpc::XmlRpcValue& users, Visit visit) {
    for (int i = 0; i < users.size(); ++i) {
      for (int j = 0; j < users[i][1].size(); ++j) {
        visit(static_cast<std::string>(users[i][0]), static_cast<std::string>(users[i][1][j]));
      }
    }
  }

  std::string map_;
  Observation* observation_;
  ros::NodeHandle node_;
  std::map<std::string, ros::Subscriber> subscribers_;
  std::map<std::string, ros::Subscriber> handles_;                     // by name of the map
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> statuses_;  // newest by name
};

}  // namespace

Observation observeGraph(const std::string& map, double seconds) {
  Observation observation;
  observation.seconds = seconds;
  ros::param::get("/use_sim_time", observation.use_sim_time);
  GraphListener(map, &observation).listen(seconds);
  if (!map.empty() && !observation.map) {
    const std::vector<std::string> maps = mapsIn(observation.types);
    throw std::invalid_argument("--map " + map + ": no such map runs; there are: " +
                                (maps.empty() ? "none" : listOf(maps)));
  }
  return observation;
}

}  // namespace fiimap
