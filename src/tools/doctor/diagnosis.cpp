#include "doctor/diagnosis.h"

#include <algorithm>

#include "doctor/checks.h"
#include "doctor/launch_line.h"
#include "doctor/launch_parameters.h"
#include "doctor/several_sensors.h"
#include "doctor/timing.h"

namespace fiimap {
namespace {

/// Of what the map would get.
std::vector<TopicHealth> topicTiming(const Examination& e) {
  std::vector<TopicHealth> topics;
  for (const ScanTopics& sensor : e.setup.allSensors()) {
    const TopicHealth scans = scanTiming(sensor, e.seen);
    if (scans.messages > 0) topics.push_back(scans);
    const auto infos = e.seen.infos.find(sensor.camera_info);
    if (infos == e.seen.infos.end()) continue;
    const bool has_stamp = true;
    topics.push_back(
        healthOf(infos->first, e.seen.types.at(infos->first), has_stamp, timesOf(infos->second)));
  }
  const TopicHealth poses = poseTiming(e);
  if (poses.messages > 0) topics.push_back(poses);
  return topics;
}

const char* nameOf(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "WRONG";
    case Severity::kWarning:
      return "ODD  ";
    default:
      return "note ";
  }
}

/// Long sentences over lines that fit a terminal.
std::string wrapped(const std::string& text, const std::string& first, const std::string& others) {
  constexpr std::size_t kWidth = 100;
  std::string all, line = first;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (line.size() + word.size() > kWidth && line.size() > others.size()) {
      all += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
      line = others;
    }
    line += word + ' ';
    begin = end + 1;
  }
  return all + line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
}

std::string toText(const Finding& finding) {
  const std::string indent = "       ";
  std::string text = wrapped(finding.what, std::string(nameOf(finding.severity)) + "  ", indent);
  if (!finding.remedy.empty()) text += wrapped("-> " + finding.remedy, indent, indent + "   ");
  if (!finding.command.empty()) text += "\n" + indent + finding.command + "\n\n";
  return text;
}

/// "110 of the 110 scans that came would have gone into the map"
std::string trialText(const Diagnosis& diagnosis) {
  const std::vector<ScanTopics>& sensors = diagnosis.setup.sensors;
  const Trial& trial = diagnosis.trial;
  std::string text = std::to_string(trial.usable) + " of the " + std::to_string(trial.scans) +
                     " scans that came would have gone into the map";
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    text += (i == 0 ? ": " : ", ") + sensors[i].name + ' ' +
            std::to_string(diagnosis.trials[i].usable) + " of " +
            std::to_string(diagnosis.trials[i].scans);
  }
  const std::size_t waiting = trial.scans - std::min(trial.scans, trial.decided());
  return waiting == 0 ? text : text + "; " + std::to_string(waiting) + " wait for later poses";
}

std::string adviceText(const Diagnosis& diagnosis, const Observation& seen) {
  if (seen.map && diagnosis.count(Severity::kError) == 0) {
    return "The map that runs has what it needs.\n";
  }
  if (isBlocked(diagnosis.findings)) {
    return "No launch line would lead to a map yet: set right what is WRONG, and ask again.\n";
  }
  if (diagnosis.launch_words.empty()) {
    return wrapped("The map that runs need not end: it goes on without " +
                       listOf(diagnosis.setup.left_out) + " until what is WRONG is set right.",
                   "", "");
  }
  std::string text = "Launch line (" + trialText(diagnosis) + "):\n\n";
  if (seen.live() && seen.clock_messages > 0 && !seen.use_sim_time) {
    text += "rosparam set /use_sim_time true\n";
  }
  text += shellCommand(diagnosis.launch_words) + '\n';
  if (!seen.map) return text;
  text += "\nEnd the map that runs first: rosnode kill " + seen.map->name + ".\n";
  if (diagnosis.kept.empty()) return text;
  return text + wrapped("The line keeps what " + seen.map->name +
                            " has set: " + listOf(diagnosis.kept) + ".",
                        "", "");
}

/// Whether there is a setup to start that no map has yet. A map that runs goes on when all that
/// is WRONG is with sensors that it can do without.
bool needsLaunchLine(const Examination& e) {
  if (isBlocked(e.findings)) return false;
  return !e.seen.map ||
         std::any_of(e.findings.begin(), e.findings.end(), [](const Finding& finding) {
           return finding.severity == Severity::kError && finding.repair == Repair::kInLaunchLine;
         });
}

void writeLaunchLine(Examination* e, Diagnosis* diagnosis) {
  diagnosis->launch_words = launchWords(e->seen, e->setup);
  diagnosis->kept = keptParameters(e->seen, e->setup);
  if (e->setup.left_out.empty()) return;
  e->note("The launch line leaves out " + listOf(e->setup.left_out) +
          " until what is WRONG there is set right.");
}

}  // namespace

std::size_t Diagnosis::count(Severity severity) const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [severity](const Finding& finding) { return finding.severity == severity; }));
}

Diagnosis diagnose(const Observation& observation, const DoctorWishes& wishes) {
  Examination e(observation, wishes);
  chooseScans(&e);
  chooseCameraInfos(&e);
  choosePoses(&e);
  checkPoseValues(&e);
  checkMapFrame(&e);
  checkPoseRate(&e);
  checkSimulatedTime(&e);
  checkSensors(&e);
  checkRunningMap(&e);

  Diagnosis diagnosis;
  diagnosis.trials = e.trials;
  diagnosis.trial = sumOf(e.trials);
  if (!isBlocked(e.findings)) {
    for (const std::string& warning : diagnosis.trial.warnings) {
      e.warn("The map would say: " + warning + ".", "");
    }
  }
  if (needsLaunchLine(e)) writeLaunchLine(&e, &diagnosis);
  diagnosis.topics = topicTiming(e);
  diagnosis.setup = e.setup;
  diagnosis.findings = e.findings;
  std::stable_sort(diagnosis.findings.begin(), diagnosis.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return diagnosis;
}

std::string toText(const Diagnosis& diagnosis, const Observation& observation) {
  std::string text = (observation.live() ? "The graph" : observation.bag) + ", " +
                     withUnit(observation.seconds, "s", 1) + ", " +
                     std::to_string(observation.messages) + " messages\n\n";
  if (!diagnosis.topics.empty()) text += toText(diagnosis.topics) + '\n';
  for (const Finding& finding : diagnosis.findings) text += toText(finding);
  if (!diagnosis.findings.empty()) text += '\n';
  text += adviceText(diagnosis, observation);
  return text;
}

}  // namespace fiimap
