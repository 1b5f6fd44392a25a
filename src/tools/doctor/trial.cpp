#include "doctor/trial.h"

#include <algorithm>
#include <functional>

#include "doctor/examination.h"
#include "fiimap/ros/scan_synchronizer.h"

namespace fiimap {
namespace {

class TrialListener : public ScanListener {
 public:
  explicit TrialListener(std::vector<Trial>* trials) : trials_(trials) {}

 private:
  void onScan(const SynchronizedScan& scan) override { ++trials_->at(scan.sensor).usable; }
  void onDrop(const Drop& drop, std::size_t sensor) override {
    Trial& trial = trials_->at(sensor);
    ++trial.dropped[drop.reason];
    trial.last_drop = drop;
  }
  void onTimeJump(const std::string& what) override { onWarning("time jumped: " + what); }
  void onWarning(const std::string& text) override {
    std::vector<std::string>& warnings = trials_->front().warnings;
    if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) {
      warnings.push_back(text);
    }
  }

  std::vector<Trial>* trials_;
};

/// What is to be done with each message, by its order of arrival.
using Actions = std::multimap<std::size_t, std::function<void(ScanSynchronizer*)>>;

template <typename Message, typename Action>
void schedule(const std::vector<Received<Message>>& messages, Action action, Actions* actions) {
  for (const Received<Message>& received : messages) {
    actions->emplace(received.order, [message = received.message, action](ScanSynchronizer* to) {
      action(message, to);
    });
  }
}

/// Those of one topic.
template <typename Message, typename Action>
void schedule(const ReceivedByTopic<Message>& all, const std::string& topic, Action action,
              Actions* actions) {
  const auto found = all.find(topic);
  if (found != all.end()) schedule(found->second, action, actions);
}

void scheduleSensor(const Observation& seen, const ScanTopics& topics, std::size_t sensor,
                    Actions* actions) {
  const auto add_scan = [sensor](const auto& scan, ScanSynchronizer* to) {
    to->add(ScanMessage(scan), Moment(), sensor);
  };
  const auto add_info = [sensor](const auto& info, ScanSynchronizer* to) { to->add(info, sensor); };
  schedule(seen.images, topics.depth_image, add_scan, actions);
  schedule(seen.infos, topics.camera_info, add_info, actions);
  schedule(seen.clouds, topics.points, add_scan, actions);
}

std::size_t scansSeen(const Observation& seen, const ScanTopics& topics) {
  const auto images = seen.images.find(topics.depth_image);
  if (images != seen.images.end()) return images->second.size();
  const auto clouds = seen.clouds.find(topics.points);
  return clouds == seen.clouds.end() ? 0 : clouds->second.size();
}

Actions actionsFor(const Observation& seen, const MapSetup& setup) {
  Actions actions;
  const auto add_pose = [](const auto& pose, ScanSynchronizer* to) { to->add(PoseMessage(*pose)); };
  schedule(seen.poses, setup.poses, add_pose, &actions);
  const std::vector<ScanTopics> sensors = setup.allSensors();
  for (std::size_t i = 0; i < sensors.size(); ++i) scheduleSensor(seen, sensors[i], i, &actions);
  const auto add_tf = [](bool is_static) {
    return [is_static](const auto& transforms, ScanSynchronizer* to) {
      to->addTf(*transforms, is_static);
    };
  };
  schedule(seen.tf, add_tf(false), &actions);
  schedule(seen.tf_static, add_tf(true), &actions);
  return actions;
}

}  // namespace

std::size_t Trial::decided() const {
  std::size_t count = usable;
  for (const auto& [reason, scans_of_reason] : dropped) count += scans_of_reason;
  return count;
}

std::vector<Trial> tryOut(const Observation& seen, const MapSetup& setup) {
  std::vector<Trial> trials;
  for (const ScanTopics& sensor : setup.allSensors()) {
    trials.emplace_back();
    trials.back().scans = scansSeen(seen, sensor);
  }
  TrialListener listener(&trials);
  ScanSynchronizer synchronizer(setup.node, &listener);
  for (const auto& [order, action] : actionsFor(seen, setup)) action(&synchronizer);
  return trials;
}

Trial sumOf(const std::vector<Trial>& trials) {
  Trial sum;
  for (const Trial& trial : trials) {
    sum.scans += trial.scans;
    sum.usable += trial.usable;
    for (const auto& [reason, count] : trial.dropped) sum.dropped[reason] += count;
    if (!trial.dropped.empty()) sum.last_drop = trial.last_drop;
    sum.warnings.insert(sum.warnings.end(), trial.warnings.begin(), trial.warnings.end());
  }
  return sum;
}

}  // namespace fiimap
