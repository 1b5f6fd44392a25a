#include <algorithm>
#include <cstddef>
#include <iterator>

#include "doctor/checks.h"
#include "doctor/scan_candidates.h"
#include "doctor/several_sensors.h"

namespace fiimap {
namespace {

// Of a LiDAR beside cameras, as in config/multi_sensor.yaml, m.
constexpr double kLidarLength = 20.0, kLidarNearest = 0.5, kLidarUpdateRange = 40.0;

void checkSensor(Examination* e) {
  checkScansCome(e);
  if (!checkEncoding(e)) return;
  checkCameraInfo(e);
  checkDepthReadings(e);
  checkCloudPoints(e);
  checkCloudFrame(e);
  checkBodyFrame(e);
  checkMount(e);
  checkScanRate(e);
  checkClocks(e);
}

/// \param sensor index in setup.sensors.
Examination examinationOf(const Examination& all, std::size_t sensor) {
  Examination one = all;
  static_cast<ScanTopics&>(one.setup) = all.setup.sensors.at(sensor);
  static_cast<SensorConfig&>(one.setup.node) = all.setup.node.sensors.at(sensor);
  static_cast<ReadingConfig&>(one.setup.mapper) = all.setup.mapper.sensors.at(sensor);
  one.setup.changes.clear();
  one.findings.clear();
  return one;
}

/// Takes over the setup of one sensor, and what was changed in it.
void takeOver(const Examination& one, std::size_t sensor, Examination* all) {
  MapSetup& setup = all->setup;
  static_cast<SensorConfig&>(setup.node.sensors.at(sensor)) = one.setup.node;
  static_cast<ReadingConfig&>(setup.mapper.sensors.at(sensor)) = one.setup.mapper;
  const std::string name = setup.sensors[sensor].name;
  const std::vector<Parameter> own = sensorParameters(&setup.mapper, &setup.node);
  for (const auto& [parameter, value] : one.setup.changes) {
    const std::string full = name + '/' + parameter;
    const bool is_own = std::any_of(own.begin(), own.end(), [&full](const Parameter& candidate) {
      return candidate.name == full;
    });
    if (is_own) {
      setup.changes[full] = value;
    } else {
      all->change(parameter, value);
    }
  }
}

bool cannotWork(const Examination& one) { return isBlocked(one.findings); }

/// Looks at each of several sensors as if it were the only one, but as those before it left the
/// setup, and at what the map would make of them all.
std::vector<Examination> lookAtEach(Examination* e) {
  std::vector<Examination> each;
  for (std::size_t i = 0; i < e->setup.sensors.size(); ++i) {
    each.push_back(examinationOf(*e, i));
    checkSensor(&each.back());
    takeOver(each.back(), i, e);
  }
  e->trials = tryOut(e->seen, e->setup);
  if (isBlocked(e->findings) || std::any_of(each.begin(), each.end(), cannotWork)) return each;
  for (std::size_t i = 0; i < each.size(); ++i) checkTrial(e->trials[i], &each[i]);
  return each;
}

void leaveOut(const std::string& name, MapSetup* setup) {
  std::vector<ScanTopics> sensors = setup->sensors;
  const auto sensor = std::find_if(sensors.begin(), sensors.end(),
                                   [&name](const ScanTopics& each) { return each.name == name; });
  const auto index = sensor - sensors.begin();
  sensors.erase(sensor);
  setup->setSensors(sensors);
  setup->left_out.push_back(name);
  setup->node.sensors.erase(setup->node.sensors.begin() + index);
  setup->mapper.sensors.erase(setup->mapper.sensors.begin() + index);
  const std::string prefix = name + '/';
  for (auto change = setup->changes.lower_bound(prefix); change != setup->changes.end();) {
    if (change->first.compare(0, prefix.size(), prefix) != 0) break;
    change = setup->changes.erase(change);
  }
}

/// A finding with the names of the sensors that it is about.
struct Said {
  Finding finding;
  std::vector<std::string> sensors;
};

/// What is the same of several is said once.
void say(const Examination& one, std::vector<Said>* all) {
  for (const Finding& finding : one.findings) {
    const auto same = std::find_if(all->begin(), all->end(), [&finding](const Said& other) {
      return other.finding.severity == finding.severity && other.finding.what == finding.what &&
             other.finding.remedy == finding.remedy;
    });
    if (same == all->end()) {
      all->push_back({finding, {one.setup.name}});
    } else {
      same->sensors.push_back(one.setup.name);
      same->finding.repair = std::min(same->finding.repair, finding.repair);
    }
  }
}

/// What is wrong with one of several sensors need not keep the others from a map: it is left out,
/// and they are looked at again, from a setup in which nothing of it stays.
void checkEach(Examination* e, std::vector<Said>* said) {
  const MapSetup before = e->setup;
  const std::vector<Examination> each = lookAtEach(e);
  std::vector<Examination> left_out;
  std::copy_if(each.begin(), each.end(), std::back_inserter(left_out), cannotWork);
  if (left_out.empty() || left_out.size() == each.size()) {
    for (const Examination& one : each) say(one, said);
    return;
  }
  e->setup = before;
  for (Examination& one : left_out) {
    for (Finding& finding : one.findings) finding.repair = Repair::kLeftOut;
    say(one, said);
    leaveOut(one.setup.name, &e->setup);
  }
  checkEach(e, said);
}

/// The defaults are those of a camera.
void giveLidarsTheirRange(Examination* e) {
  const std::vector<ScanTopics>& sensors = e->setup.sensors;
  const auto is_lidar = [e](const ScanTopics& sensor) { return isLidar(sensor.points, e->seen); };
  const bool has_config = std::all_of(sensors.begin(), sensors.end(), is_lidar);  // lidar.launch
  if (e->seen.map || has_config) return;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string prefix = sensors[i].name + '/';
    const auto is_open = [&](const std::string& parameter) {
      return !e->isGiven(parameter) && !e->isGiven(prefix + parameter);
    };
    if (!is_lidar(sensors[i]) || !is_open("max_ray_length")) continue;
    ReadingConfig& reading = e->setup.mapper.sensors[i];
    reading.max_ray_length = kLidarLength;
    if (is_open("min_ray_length")) reading.min_ray_length = kLidarNearest;
    for (const char* range : {"local_update_range_x", "local_update_range_y"}) {
      if (!e->isGiven(range)) e->change(range, plainNumber(kLidarUpdateRange));
    }
    e->note("The clouds of '" + sensors[i].name + "' reach far, as a LiDAR's do: its rays are " +
                withUnit(kLidarLength, "m", 0) + " long, and what a scan may change is " +
                withUnit(kLidarUpdateRange, "m", 0) + " wide.",
            "Set " + prefix +
                "max_ray_length and local_update_range_x, _y for other lengths; "
                "config/multi_sensor.yaml is such a map.");
  }
}

}  // namespace

bool isBlocked(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == Severity::kError && finding.repair == Repair::kNone;
  });
}

void checkSensors(Examination* e) {
  if (e->setup.sensors.empty()) {
    checkSensor(e);
    e->trials = tryOut(e->seen, e->setup);
    if (!isBlocked(e->findings)) checkTrial(e->trials.front(), e);
    return;
  }
  const std::size_t count = e->setup.sensors.size();
  std::vector<Said> said;
  checkEach(e, &said);
  for (Said& each : said) {
    if (each.sensors.size() < count) {
      each.finding.what = listOf(each.sensors) + ": " + each.finding.what;
    }
    e->findings.push_back(each.finding);
  }
  giveLidarsTheirRange(e);
}

}  // namespace fiimap
