#include "health/topic_health.h"

#include <ros/serialization.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cstdio>

#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

constexpr double kGapFactor = 2.0;

/// A message begins with a header when its definition does.
bool beginsWithHeader(const rosbag::MessageInstance& instance) {
  const std::string definition = instance.getMessageDefinition();
  const std::size_t separator = definition.find("\n====");
  for (const char* header : {"Header header", "std_msgs/Header header"}) {
    const std::size_t found = definition.find(std::string("\n") + header);
    if (definition.find(header) == 0 || (found != std::string::npos && found < separator)) {
      return true;
    }
  }
  return false;
}

/// Reads no more of the message than its header.
ros::Time stampOf(const rosbag::MessageInstance& instance, std::vector<std::uint8_t>* buffer) {
  buffer->resize(instance.size());
  ros::serialization::OStream out(buffer->data(), instance.size());
  instance.write(out);
  ros::serialization::IStream in(buffer->data(), instance.size());
  std::uint32_t sequence;
  ros::Time stamp;
  in.next(sequence);
  in.next(stamp);
  return stamp;
}

std::vector<double> intervalsOf(const std::vector<double>& times) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  return intervals;
}

void summarise(const std::vector<double>& times, const std::vector<double>& delays,
               TopicHealth* health) {
  if (times.empty()) return;
  health->duration = times.back() - times.front();
  const std::vector<double> intervals = intervalsOf(times);
  health->interval = quantilesOf(intervals);
  for (const double interval : intervals) {
    if (interval > kGapFactor * health->interval.median) ++health->gaps;
    if (interval <= 0.0) ++health->backward;
  }
  health->delay = quantilesOf(delays);
  if (!delays.empty()) health->least_delay = *std::min_element(delays.begin(), delays.end());
}

nlohmann::json quantilesToJson(const Quantiles& q) {
  return {{"median", q.median}, {"p95", q.p95}, {"max", q.max}};
}

}  // namespace

TopicHealth healthOf(const std::string& topic, const std::string& type, bool has_stamp,
                     const std::vector<MessageTime>& messages) {
  TopicHealth health;
  health.topic = topic;
  health.type = type;
  health.has_stamp = has_stamp;
  health.messages = messages.size();
  std::vector<double> times, delays;
  for (const MessageTime& message : messages) {
    times.push_back(secondsBetween(messages.front().received, message.stamp));
    if (has_stamp) delays.push_back(secondsBetween(message.stamp, message.received));
  }
  summarise(times, delays, &health);
  return health;
}

TopicHealth healthOf(const rosbag::Bag& bag, const std::string& topic) {
  std::string type;
  bool has_stamp = false;
  std::vector<std::uint8_t> buffer;
  std::vector<MessageTime> messages;
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view) {
    if (messages.empty()) {
      type = instance.getDataType();
      has_stamp = beginsWithHeader(instance);
    }
    const ros::Time recorded = instance.getTime();
    messages.push_back({recorded, has_stamp ? stampOf(instance, &buffer) : recorded});
  }
  return healthOf(topic, type, has_stamp, messages);
}

nlohmann::json toJson(const TopicHealth& health) {
  nlohmann::json json = {
      {"topic", health.topic},
      {"type", health.type},
      {"messages", health.messages},
      {"duration_s", health.duration},
      {"rate_hz", health.duration > 0.0 ? (health.messages - 1) / health.duration : 0.0},
      {"interval_s", quantilesToJson(health.interval)},
      {"gaps", health.gaps},
      {"backward", health.backward},
  };
  if (health.has_stamp) {
    json["delay_s"] = quantilesToJson(health.delay);
    json["delay_s"]["min"] = health.least_delay;
  }
  return json;
}

std::string toText(const std::vector<TopicHealth>& topics) {
  std::string text =
      "messages      Hz  interval: median, max ms    gaps  delay: median, max ms  topic\n";
  constexpr double kMilliseconds = 1e3;
  for (const TopicHealth& health : topics) {
    char line[256];
    std::snprintf(line, sizeof(line), "%8zu %7.2f %15.1f %11.1f %7zu %12.1f %9.1f  %s\n",
                  health.messages, toJson(health)["rate_hz"].get<double>(),
                  health.interval.median * kMilliseconds, health.interval.max * kMilliseconds,
                  health.gaps, health.delay.median * kMilliseconds,
                  health.delay.max * kMilliseconds, health.topic.c_str());
    text += line;
  }
  return text;
}

}  // namespace fiimap
