#include "doctor/trial.h"

#include <algorithm>
#include <functional>

#include "fiimap/ros/scan_synchronizer.h"

namespace fiimap {
namespace {

class TrialListener : public ScanListener {
 public:
  explicit TrialListener(Trial* trial) : trial_(trial) {}

 private:
  void onScan(const SynchronizedScan& /*scan*/) override { ++trial_->usable; }
  void onDrop(const Drop& drop, std::size_t /*sensor*/) override {
    ++trial_->dropped[drop.reason];
    trial_->last_drop = drop;
  }
  void onTimeJump(const std::string& what) override { onWarning("time jumped: " + what); }
  void onWarning(const std::string& text) override {
    std::vector<std::string>& warnings = trial_->warnings;
    if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) {
      warnings.push_back(text);
    }
  }

  Trial* trial_;
};

/// What is to be done with each message, by its order of arrival.
using Actions = std::map<std::size_t, std::function<void(ScanSynchronizer*)>>;

template <typename Message, typename Action>
void schedule(const std::vector<Received<Message>>& messages, Action action, Actions* actions) {
  for (const Received<Message>& received : messages) {
    (*actions)[received.order] = [message = received.message, action](ScanSynchronizer* to) {
      action(message, to);
    };
  }
}

/// Those of one topic.
template <typename Message, typename Action>
void schedule(const ReceivedByTopic<Message>& all, const std::string& topic, Action action,
              Actions* actions) {
  const auto found = all.find(topic);
  if (found != all.end()) schedule(found->second, action, actions);
}

Actions actionsFor(const Observation& seen, const MapSetup& setup) {
  Actions actions;
  const auto add_scan = [](const auto& scan, ScanSynchronizer* to) { to->add(ScanMessage(scan)); };
  const auto add_info = [](const auto& info, ScanSynchronizer* to) { to->add(info); };
  const auto add_pose = [](const auto& pose, ScanSynchronizer* to) { to->add(PoseMessage(*pose)); };
  schedule(seen.images, setup.depth_image, add_scan, &actions);
  schedule(seen.infos, setup.camera_info, add_info, &actions);
  schedule(seen.clouds, setup.points, add_scan, &actions);
  schedule(seen.poses, setup.poses, add_pose, &actions);
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

Trial tryOut(const Observation& seen, const MapSetup& setup) {
  Trial trial;
  if (setup.scans().empty()) return trial;
  const auto images = seen.images.find(setup.depth_image);
  const auto clouds = seen.clouds.find(setup.points);
  trial.scans = images != seen.images.end()   ? images->second.size()
                : clouds != seen.clouds.end() ? clouds->second.size()
                                              : 0;
  TrialListener listener(&trial);
  ScanSynchronizer synchronizer(setup.node, &listener);
  for (const auto& [order, action] : actionsFor(seen, setup)) action(&synchronizer);
  return trial;
}

}  // namespace fiimap
