#include "doctor/topic_choice.h"

#include <algorithm>
#include <stdexcept>

namespace fiimap {

std::vector<std::string> topicsOfType(const std::string& type, const Observation& observation) {
  std::vector<std::string> topics;
  for (const auto& [topic, type_of_topic] : observation.types) {
    if (type_of_topic == type) topics.push_back(topic);
  }
  return topics;
}

std::string listenedTo(const std::string& type, const Observation& observation,
                       const std::vector<std::string>& candidates) {
  if (!observation.map) return "";
  std::string first;
  for (const auto& [topic, type_of_topic] : observation.map->inputs) {
    if (type_of_topic != type) continue;
    if (std::find(candidates.begin(), candidates.end(), topic) != candidates.end()) return topic;
    if (first.empty()) first = topic;
  }
  return first;
}

void requireType(const std::string& topic, const std::vector<std::string>& types,
                 const std::string& option, const Observation& observation) {
  const auto found = observation.types.find(topic);
  if (found != observation.types.end() &&
      std::find(types.begin(), types.end(), found->second) != types.end()) {
    return;
  }
  std::vector<std::string> candidates;
  for (const std::string& type : types) {
    for (const std::string& other : topicsOfType(type, observation)) candidates.push_back(other);
  }
  throw std::invalid_argument(option + " " + topic + ": " +
                              (found == observation.types.end() ? "there is no such topic"
                                                                : "its type is " + found->second) +
                              "; must be of type " + listOf(types) + ": " +
                              (candidates.empty() ? "there is none" : listOf(candidates)));
}

void noteOthers(const std::string& what, const std::string& chosen,
                const std::vector<std::string>& all, const std::string& option,
                Examination* examination) {
  std::vector<std::string> others;
  for (const std::string& topic : all) {
    if (topic != chosen) others.push_back(topic);
  }
  if (others.empty()) return;
  examination->note(
      "Of several " + what + ", " + chosen + " is looked at; the others: " + listOf(others) + ".",
      "Choose with " + option + " TOPIC.");
}

}  // namespace fiimap
