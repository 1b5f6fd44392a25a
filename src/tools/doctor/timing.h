#pragma once

#include <string>
#include <vector>

#include "doctor/examination.h"
#include "health/topic_health.h"

namespace fiimap {

/// When messages came and how they are stamped.
template <typename Message>
std::vector<MessageTime> timesOf(const std::vector<Received<Message>>& messages) {
  std::vector<MessageTime> times;
  for (const Received<Message>& message : messages) {
    times.push_back({message.time, message.message->header.stamp});
  }
  return times;
}

/// Of the scans of a sensor; without messages where there are none.
TopicHealth scanTiming(const ScanTopics& sensor, const Observation& observation);
/// Of the poses that were chosen: for TF the slowest link that moves between sensor and map frame.
TopicHealth poseTiming(const Examination& examination);

}  // namespace fiimap
