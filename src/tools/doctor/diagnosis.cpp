#include "doctor/diagnosis.h"

#include <algorithm>

#include "doctor/checks.h"
#include "doctor/launch_line.h"
#include "doctor/timing.h"

namespace fiimap {
namespace {

constexpr double kManyLost = 0.1;  // of the scans

/// What the checks did not foresee, the node's own synchronisation shows.
void judge(const Trial& trial, Examination* e) {
  for (const std::string& warning : trial.warnings)
    e->warn("The map would say: " + warning + ".", "");
  const std::size_t decided = trial.decided();
  if (decided == 0) {
    if (trial.scans > 0 && e->setup.has_poses) {
      e->error("Of " + std::to_string(trial.scans) +
                   " scans none found a pose: each still waits "
                   "for one of its time.",
               "Look for longer with --seconds.");
    }
    return;
  }
  const std::size_t lost = decided - trial.usable;
  const std::string what = std::to_string(lost) + " of " + std::to_string(decided) +
                           " scans would be dropped, the last for " + trial.last_drop.detail;
  const std::string remedy = remedyFor(trial.last_drop.reason) + ".";
  if (trial.usable == 0) {
    e->error("No scan would go into the map: " + what + ".", remedy);
  } else if (static_cast<double>(lost) > kManyLost * static_cast<double>(decided)) {
    e->warn(what + ".", remedy);
  }
}

/// Of what the map would get.
std::vector<TopicHealth> topicTiming(const Examination& e) {
  std::vector<TopicHealth> topics;
  const TopicHealth scans = scanTiming(e), poses = poseTiming(e);
  if (scans.messages > 0) topics.push_back(scans);
  const auto infos = e.seen.infos.find(e.setup.camera_info);
  if (infos != e.seen.infos.end()) {
    const bool has_stamp = true;
    topics.push_back(
        healthOf(infos->first, e.seen.types.at(infos->first), has_stamp, timesOf(infos->second)));
  }
  if (poses.messages > 0) topics.push_back(poses);
  return topics;
}

bool isBlocked(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == Severity::kError && finding.repair == Repair::kNone;
  });
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

std::string adviceText(const Diagnosis& diagnosis, const Observation& seen) {
  if (seen.map && diagnosis.count(Severity::kError) == 0) {
    return "The map that runs has what it needs.\n";
  }
  if (diagnosis.launch_words.empty()) {
    return "No launch line would lead to a map yet: set right what is WRONG, and ask again.\n";
  }
  const Trial& trial = diagnosis.trial;
  std::string text = "Launch line (" + std::to_string(trial.usable) + " of the " +
                     std::to_string(trial.scans) + " scans that came would have gone into the map";
  if (trial.scans > trial.decided()) {
    text += ", " + std::to_string(trial.scans - trial.decided()) + " wait for later poses";
  }
  text += "):\n\n";
  if (seen.live() && seen.clock_messages > 0 && !seen.use_sim_time) {
    text += "rosparam set /use_sim_time true\n";
  }
  return text + shellCommand(diagnosis.launch_words) + '\n';
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
  choosePoses(&e);
  checkCameraInfo(&e);
  checkDepthReadings(&e);
  checkCloudPoints(&e);
  checkPoseValues(&e);
  checkMapFrame(&e);
  checkCloudFrame(&e);
  checkBodyFrame(&e);
  checkMount(&e);
  checkRates(&e);
  checkClocks(&e);
  checkSimulatedTime(&e);
  checkRunningMap(&e);

  Diagnosis diagnosis;
  diagnosis.trial = tryOut(observation, e.setup);
  if (!isBlocked(e.findings)) judge(diagnosis.trial, &e);
  if (!isBlocked(e.findings)) diagnosis.launch_words = launchWords(observation, e.setup);
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
