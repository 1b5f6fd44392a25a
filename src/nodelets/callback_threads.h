#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

namespace fiimap {

/// A queue of ROS callbacks and the threads that call them, for a nodelet that may be unloaded at
/// any moment. With the queues of its manager a nodelet is not safe then: a callback that runs
/// keeps the nodelet, and it is destroyed when the callback ends, in the manager's thread, where
/// one of its two queues may be gone already. And here no slow nodelet beside it holds up its
/// callbacks.
class CallbackThreads {
 public:
  /// \param count with one thread, callbacks are called one after another in their order.
  explicit CallbackThreads(unsigned count) : spinner_(count, &queue_) {}
  ~CallbackThreads() { stop(); }

  /// The node handle whose callbacks are called here.
  ros::NodeHandle attach(const ros::NodeHandle& node);
  /// Callbacks wait until then.
  void start() { spinner_.start(); }
  /// No callback is running any more when this returns, nor called again.
  void stop();

 private:
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_;
};

}  // namespace fiimap
