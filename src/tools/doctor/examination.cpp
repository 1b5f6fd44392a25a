#include "doctor/examination.h"

#include <cstdio>
#include <stdexcept>

#include "fiimap/ros/frame_id.h"

namespace fiimap {
namespace {

bool hasMessages(const std::string& topic, const Observation& seen) {
  return seen.images.count(topic) != 0 || seen.clouds.count(topic) != 0;
}

}  // namespace

Examination::Examination(const Observation& observation, const DoctorWishes& chosen)
    : seen(observation), wishes(chosen), frames(observation) {
  if (seen.map) given = seen.map->parameters;
  for (const auto& [name, value] : wishes.parameters) given[name] = value;
  // Its own parameters are for a map that runs to complain of, those of the user are for us.
  const std::vector<std::string> unknown =
      configure(seen.map ? given : wishes.parameters, &setup.mapper, &setup.node);
  for (const std::string& name : unknown) {
    if (wishes.parameters.count(name) == 0) continue;
    throw std::invalid_argument("unknown parameter " + name + ": fiimap_eval parameters lists all");
  }
  setup.changes = wishes.parameters;
}

std::vector<ScanTopics> MapSetup::allSensors() const {
  return sensors.empty() ? std::vector<ScanTopics>{*this} : sensors;
}

void MapSetup::setSensors(const std::vector<ScanTopics>& several) {
  sensors = several;
  static_cast<ScanTopics&>(*this) = several.front();
  name.clear();
}

void Examination::note(const std::string& what, const std::string& remedy) {
  findings.push_back({Severity::kNote, what, remedy});
}

void Examination::warn(const std::string& what, const std::string& remedy) {
  findings.push_back({Severity::kWarning, what, remedy});
}

void Examination::error(const std::string& what, const std::string& remedy, Repair repair,
                        const std::string& command) {
  findings.push_back({Severity::kError, what, remedy, repair, command});
}

void Examination::change(const std::string& parameter, const std::string& value) {
  for (const auto& list : {nodeParameters(&setup.node), mapperParameters(&setup.mapper)}) {
    applyParameters({{parameter, value}}, list);
  }
  setup.changes[parameter] = value;
}

bool Examination::hasScans() const { return hasMessages(setup.scans(), seen); }

std::string Examination::sensorFrame() const { return frameOfScans(setup.scans(), seen); }

std::vector<std::string> Examination::sensorFrames() const {
  std::vector<std::string> names;
  for (const ScanTopics& sensor : setup.allSensors()) {
    if (hasMessages(sensor.scans(), seen)) names.push_back(frameOfScans(sensor.scans(), seen));
  }
  return names;
}

std::string frameOfScans(const std::string& topic, const Observation& seen) {
  if (!hasMessages(topic, seen)) return "";
  const auto images = seen.images.find(topic);
  return plainFrame(images != seen.images.end()
                        ? images->second.front().message->header.frame_id
                        : seen.clouds.at(topic).front().message->header.frame_id);
}

std::string withUnit(double value, const char* unit, int digits) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f %s", digits, value, unit);
  return text;
}

std::string plainNumber(double value) {
  char digits[64];
  std::snprintf(digits, sizeof(digits), "%.6f", value);
  std::string text = digits;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string percent(double share) {
  constexpr double kPercent = 100.0;
  return withUnit(share * kPercent, "%", 0);
}

std::string listOf(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace fiimap
