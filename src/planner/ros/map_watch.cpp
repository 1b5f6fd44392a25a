#include "map_watch.h"

#include <cmath>
#include <sstream>

namespace fiimap {

MapWatch::MapWatch(ros::NodeHandle node, const std::string& map, double timeout)
    : map_(map), timeout_(timeout) {
  constexpr int kQueue = 1;
  subscriber_ = node.subscribe(map + "/map_handle", kQueue, &MapWatch::onMap, this);
}

void MapWatch::onMap(const MapHandleMessage::ConstPtr& message) {
  const double now = ros::Time::now().toSec();
  const std::lock_guard<std::mutex> lock(mutex_);
  // Of two nodelets of this name, the one that goes may be heard last. It does not count while the
  // other one works.
  const bool is_other = handle_ && message->handle != handle_;
  const bool works = newest_ && std::abs(now - newest_time_) <= timeout_;
  if (is_other && works && message->info.header.stamp < stamp_) return;
  stamp_ = message->info.header.stamp;
  frame_ = message->info.header.frame_id;
  // Null when the map is in another process.
  if (message->handle) handle_ = message->handle;
}

MapWatch::View MapWatch::look(double time) {
  const bool is_connected = subscriber_.getNumPublishers() > 0;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (was_connected_ && !is_connected) {
    // Its last snapshot will never be renewed; one that comes back has another handle.
    handle_.reset();
    newest_.reset();
    is_gone_ = true;
  }
  was_connected_ = is_connected;
  if (!handle_) handle_ = MapRegistry::find(map_);
  const std::shared_ptr<const Snapshot> snapshot = handle_ ? handle_->latest() : nullptr;
  if (snapshot && snapshot != newest_) {
    newest_ = snapshot;
    newest_time_ = time;
    is_gone_ = false;
  }
  return {snapshot, findTrouble(time)};
}

std::string MapWatch::findTrouble(double time) const {
  if (is_gone_) return "the mapping nodelet " + map_ + " is gone";
  if (!handle_) {
    return "there is no map " + map_ +
           ": load fiimap/MappingNodelet with this name into the same nodelet manager, or set the "
           "parameter map";
  }
  if (!newest_) return "the map " + map_ + " has no scan yet: see its warnings and /diagnostics";
  // The handle may be found before the map's first message.
  if (frame_.empty()) return "the map " + map_ + " has not told its frame yet";
  // Also after a jump back in time: what was new before it may be long ago.
  if (std::abs(time - newest_time_) > timeout_) {
    std::ostringstream text;
    text << "the map " << map_ << " had no new scan for more than " << timeout_
         << " s: see its warnings and /diagnostics";
    return text.str();
  }
  return "";
}

std::string MapWatch::frame() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return frame_;
}

}  // namespace fiimap
