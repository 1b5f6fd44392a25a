#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/wall_timer.h>
#include <std_msgs/Header.h>

#include "fiimap/snapshot.h"
#include "publishing_thread.h"

namespace fiimap {

/// Publishes on ~changes what is new in the newest snapshot since the one before, in its own
/// thread, only while somebody subscribes and at most at a given rate. Everybody gets a keyframe
/// when somebody subscribes, and one in every period, also when the map stays as it is or there is
/// none. Thread-safe.
class ChangesPublisher {
 public:
  /// \param node where the topic is advertised; \param rate Hz; \param keyframe_period s.
  ChangesPublisher(ros::NodeHandle node, const std::string& map_frame, double rate,
                   double keyframe_period);
  ~ChangesPublisher();

  void setRate(double rate) { thread_.setRate(rate); }

  /// \param snapshot null: the map was forgotten.
  void offer(std::shared_ptr<const Snapshot> snapshot);

 private:
  void requestKeyframe();
  void publish();
  std_msgs::Header headerOfNow() const;

  std::string map_frame_;
  std::mutex mutex_;
  std::shared_ptr<const Snapshot> newest_;  // null: there is no map
  bool wants_keyframe_ = true;

  std::shared_ptr<const Snapshot> published_;  // of the thread alone; null: the next is a keyframe
  ros::Publisher publisher_;
  ros::WallTimer keyframe_timer_;
  PublishingThread thread_;  // last, because it uses the others
};

}  // namespace fiimap
