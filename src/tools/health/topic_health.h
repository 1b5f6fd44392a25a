#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "quantiles.h"

namespace fiimap {

/// How regularly the messages of a topic were stamped and recorded. Times in seconds.
struct TopicHealth {
  std::string topic;
  std::string type;
  std::size_t messages = 0;
  double duration = 0.0;     ///< from the first to the last
  Quantiles interval;        ///< between stamps
  std::size_t gaps = 0;      ///< intervals of more than twice the median
  std::size_t backward = 0;  ///< stamps that are not after the one before
  Quantiles delay;           ///< from stamp to recording
  double least_delay = 0.0;
  bool has_stamp = false;  ///< false: times of recording instead of stamps, no delay
};

/// When a message was received, or recorded, and how it was stamped.
struct MessageTime {
  ros::Time received;
  ros::Time stamp;  ///< that of receipt for messages without one
};

/// \param messages in the order of arrival.
/// \param has_stamp whether they have stamps of their own.
TopicHealth healthOf(const std::string& topic, const std::string& type, bool has_stamp,
                     const std::vector<MessageTime>& messages);

/// \throws std::exception when the bag cannot be read.
TopicHealth healthOf(const rosbag::Bag& bag, const std::string& topic);

/// Keys as documented in docs/evaluation.md.
nlohmann::json toJson(const TopicHealth& health);
/// The table for people.
std::string toText(const std::vector<TopicHealth>& topics);

}  // namespace fiimap
