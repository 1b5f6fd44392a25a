#include "callback_threads.h"

namespace fiimap {

ros::NodeHandle CallbackThreads::attach(const ros::NodeHandle& node) {
  ros::NodeHandle attached(node);
  attached.setCallbackQueue(&queue_);
  return attached;
}

void CallbackThreads::stop() {
  queue_.disable();  // wakes threads that wait for a callback
  spinner_.stop();
}

}  // namespace fiimap
