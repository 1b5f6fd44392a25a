#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <ros/ros.h>

#include "fiimap/map_handle.h"
#include "fiimap/ros/map_handle_message.h"

namespace fiimap {

/// Follows the map of a mapping nodelet in the same manager, whoever comes or goes first.
/// Thread-safe.
class MapWatch {
 public:
  struct View {
    std::shared_ptr<const Snapshot> snapshot;  ///< null: nothing is known now
    std::string trouble;                       ///< why the map cannot be trusted; empty: it can
  };

  /// \param map full name of the mapping nodelet.
  /// \param timeout s without a new snapshot after which the map is not trusted any more.
  MapWatch(ros::NodeHandle node, const std::string& map, double timeout);
  /// No callback is running any more when it is gone.
  ~MapWatch() { subscriber_.shutdown(); }

  /// \param time now, s.
  View look(double time);
  /// Frame of the map; empty when no message came yet.
  std::string frame() const;

 private:
  void onMap(const MapHandleMessage::ConstPtr& message);
  std::string findTrouble(double time) const;

  std::string map_;
  double timeout_;
  mutable std::mutex mutex_;
  std::string frame_;
  ros::Time stamp_;  ///< of the newest message
  std::shared_ptr<const MapHandle> handle_;
  std::shared_ptr<const Snapshot> newest_;
  double newest_time_ = 0.0;  ///< when it was new, s
  bool was_connected_ = false;
  bool is_gone_ = false;
  ros::Subscriber subscriber_;  ///< last: its callbacks use the others
};

}  // namespace fiimap
