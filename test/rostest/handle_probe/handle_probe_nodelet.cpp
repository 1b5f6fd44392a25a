#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>

#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_list_macros.hpp>

#include "fiimap/map_handle.h"
#include "fiimap/ros/map_handle_message.h"
#include "snapshot_check.h"

namespace fiimap {

/// Reads the map that the parameter ~map names, in a thread of its own, and answers ~report with
/// what it saw: success when nothing was wrong, message "name=number ...".
class HandleProbe : public nodelet::Nodelet {
 public:
  ~HandleProbe() override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void onInit() override;
  void onHandle(const MapHandleMessage::ConstPtr& message);
  void onCloud(const sensor_msgs::PointCloud2::ConstPtr& cloud);
  bool onReport(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void take(const std::shared_ptr<const MapHandle>& handle);
  void read();

  std::string map_;
  std::mutex mutex_;
  std::shared_ptr<const MapHandle> handle_;
  SnapshotCheck check_;
  std::uint64_t messages_ = 0;
  std::uint64_t null_handles_ = 0;
  std::uint64_t strangers_ = 0;  ///< handles that the registry does not know under the map's name
  std::uint64_t handles_ = 0;    ///< different ones

  ros::Subscriber handle_subscriber_;
  ros::Subscriber cloud_subscriber_;
  ros::ServiceServer report_server_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

void HandleProbe::onInit() {
  ros::NodeHandle& node = getPrivateNodeHandle();
  if (!node.getParam("map", map_)) throw std::runtime_error("parameter map is not set");
  constexpr int kQueue = 100;
  handle_subscriber_ = node.subscribe(map_ + "/map_handle", kQueue, &HandleProbe::onHandle, this);
  cloud_subscriber_ = node.subscribe(map_ + "/occupied", kQueue, &HandleProbe::onCloud, this);
  report_server_ = node.advertiseService("report", &HandleProbe::onReport, this);
  thread_ = std::thread([this] { read(); });
}

void HandleProbe::onHandle(const MapHandleMessage::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++messages_;
  if (!message->handle) {
    ++null_handles_;
    return;
  }
  if (MapRegistry::find(message->info.id) != message->handle || message->info.id != map_) {
    ++strangers_;
  }
  take(message->handle);
}

void HandleProbe::take(const std::shared_ptr<const MapHandle>& handle) {
  if (handle == handle_) return;
  handle_ = handle;
  ++handles_;
  check_.onNewHandle();
}

void HandleProbe::onCloud(const sensor_msgs::PointCloud2::ConstPtr& cloud) {
  const std::lock_guard<std::mutex> lock(mutex_);
  check_.look(*cloud);
}

void HandleProbe::read() {
  while (!stopping_) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!handle_) {
        const std::shared_ptr<const MapHandle> found = MapRegistry::find(map_);
        if (found) take(found);
      }
      if (handle_) check_.look(handle_->latest());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

bool HandleProbe::onReport(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::ostringstream report;
  report << "publishers=" << handle_subscriber_.getNumPublishers() << " messages=" << messages_
         << " null_handles=" << null_handles_ << " strangers=" << strangers_
         << " handles=" << handles_ << " registered=" << (MapRegistry::find(map_) ? 1 : 0)
         << " snapshots=" << check_.snapshots() << " clouds=" << check_.clouds()
         << " sequence=" << check_.sequence();
  response.success = check_.failure().empty();
  response.message = response.success ? report.str() : check_.failure();
  return true;
}

}  // namespace fiimap

PLUGINLIB_EXPORT_CLASS(fiimap::HandleProbe, nodelet::Nodelet)
