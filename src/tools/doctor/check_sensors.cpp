#include <algorithm>
#include <cstddef>

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

/// A finding with the names of the sensors that it is about.
struct Said {
  Finding finding;
  std::vector<std::string> sensors;
};

/// What is the same of several is said once.
void say(const Finding& finding, const std::string& sensor, std::vector<Said>* all) {
  const auto same = std::find_if(all->begin(), all->end(), [&finding](const Said& other) {
    return other.finding.severity == finding.severity && other.finding.what == finding.what &&
           other.finding.remedy == finding.remedy;
  });
  if (same == all->end()) {
    all->push_back({finding, {sensor}});
  } else {
    same->sensors.push_back(sensor);
  }
}

/// What is wrong with one of several sensors need not keep the others from a map.
void leaveOut(std::size_t sensor, Examination* all) {
  MapSetup& setup = all->setup;
  const std::string prefix = setup.sensors[sensor].name + '/';
  const auto index = static_cast<std::ptrdiff_t>(sensor);
  setup.sensors.erase(setup.sensors.begin() + index);
  setup.node.sensors.erase(setup.node.sensors.begin() + index);
  setup.mapper.sensors.erase(setup.mapper.sensors.begin() + index);
  for (auto change = setup.changes.lower_bound(prefix); change != setup.changes.end();) {
    if (change->first.compare(0, prefix.size(), prefix) != 0) break;
    change = setup.changes.erase(change);
  }
}

/// The defaults are those of a camera.
void giveLidarsTheirRange(Examination* e) {
  const std::vector<ScanTopics>& sensors = e->setup.sensors;
  const auto is_lidar = [e](const ScanTopics& sensor) { return isLidar(sensor.points, e->seen); };
  const bool of_all = std::all_of(sensors.begin(), sensors.end(), is_lidar);
  const bool has_config = !e->seen.map && of_all;  // lidar.launch
  if (e->seen.map || has_config) return;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string max_length = sensors[i].name + "/max_ray_length";
    if (!is_lidar(sensors[i]) || e->isGiven(max_length) || e->isGiven("max_ray_length")) continue;
    e->setup.mapper.sensors[i].max_ray_length = kLidarLength;
    e->setup.mapper.sensors[i].min_ray_length = kLidarNearest;
    for (const char* range : {"local_update_range_x", "local_update_range_y"}) {
      if (!e->isGiven(range)) e->change(range, plainNumber(kLidarUpdateRange));
    }
    e->note("The clouds of '" + sensors[i].name + "' reach far, as a LiDAR's do: its rays are " +
                withUnit(kLidarLength, "m", 0) + " long, and what a scan may change is " +
                withUnit(kLidarUpdateRange, "m", 0) + " wide.",
            "Set " + max_length +
                " and local_update_range_x, _y for other lengths; "
                "config/multi_sensor.yaml is such a map.");
  }
}

/// \return the names of the sensors that no launch line can make work, of those that leave others.
std::vector<std::string> leaveOutBlocked(const std::vector<bool>& is_blocked, Examination* e) {
  std::vector<std::string> names;
  const auto blocked = std::count(is_blocked.begin(), is_blocked.end(), true);
  if (blocked == static_cast<std::ptrdiff_t>(is_blocked.size())) return names;
  for (std::size_t i = is_blocked.size(); i-- > 0;) {
    if (!is_blocked[i]) continue;
    names.insert(names.begin(), e->setup.sensors[i].name);
    leaveOut(i, e);
  }
  return names;
}

void checkEach(Examination* e) {
  std::vector<Said> said;
  std::vector<bool> is_blocked;
  for (std::size_t i = 0; i < e->setup.sensors.size(); ++i) {
    Examination one = examinationOf(*e, i);
    checkSensor(&one);
    is_blocked.push_back(isBlocked(one.findings));
    takeOver(one, i, e);
    for (const Finding& finding : one.findings) say(finding, e->setup.sensors[i].name, &said);
  }
  const std::size_t count = e->setup.sensors.size();
  const std::vector<std::string> left_out = leaveOutBlocked(is_blocked, e);
  for (Said& each : said) {
    if (!left_out.empty()) each.finding.repair = Repair::kInLaunchLine;
    if (each.sensors.size() < count) {
      each.finding.what = listOf(each.sensors) + ": " + each.finding.what;
    }
    e->findings.push_back(each.finding);
  }
  if (left_out.empty()) return;
  e->note("The launch line leaves out " + listOf(left_out) +
          " until what is WRONG there is set right.");
}

/// The first of those that are left is that of the setup, too.
void lookAtTheFirst(MapSetup* setup) {
  static_cast<ScanTopics&>(*setup) = setup->sensors.front();
  setup->name.clear();
}

}  // namespace

Examination examinationOf(const Examination& all, std::size_t sensor) {
  Examination one = all;
  static_cast<ScanTopics&>(one.setup) = all.setup.sensors.at(sensor);
  static_cast<SensorConfig&>(one.setup.node) = all.setup.node.sensors.at(sensor);
  static_cast<ReadingConfig&>(one.setup.mapper) = all.setup.mapper.sensors.at(sensor);
  one.setup.changes.clear();
  one.findings.clear();
  return one;
}

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

bool isBlocked(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == Severity::kError && finding.repair == Repair::kNone;
  });
}

void checkSensors(Examination* e) {
  if (e->setup.sensors.empty()) {
    checkSensor(e);
    return;
  }
  checkEach(e);
  lookAtTheFirst(&e->setup);
  giveLidarsTheirRange(e);
}

}  // namespace fiimap
