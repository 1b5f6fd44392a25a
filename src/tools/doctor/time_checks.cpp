#include <algorithm>
#include <cmath>
#include <cstddef>

#include "doctor/checks.h"
#include "doctor/timing.h"
#include "fiimap/ros/stamps.h"

namespace fiimap {
namespace {

constexpr double kSlowScans = 2.0;    // Hz
constexpr double kManyGaps = 0.02;    // of the intervals
constexpr double kRoom = 1.5;         // times the usual interval
constexpr double kStep = 0.05;        // s, of the times that are suggested
constexpr double kRounding = 1e-6;    // steps
constexpr double kNoticeable = 0.15;  // s between the stamps of scans and poses of one moment
constexpr double kOtherClock = 1.0;   // s between them that no delay explains
constexpr double kFuture = 0.05;      // s
constexpr double kMostOffset = 3600;  // s, of time_offset
constexpr double kOtherTime = 60.0;   // s between the clock and all stamps

double roundedUp(double seconds) { return std::ceil(seconds / kStep - kRounding) * kStep; }

double rateOf(const TopicHealth& health) {
  return health.duration > 0.0 ? static_cast<double>(health.messages - 1) / health.duration : 0.0;
}

/// Messages of a topic that have no stamp.
template <typename Messages>
std::ptrdiff_t countUnstamped(const Messages& by_topic, const std::string& topic) {
  const auto found = by_topic.find(topic);
  if (found == by_topic.end()) return 0;
  return std::count_if(found->second.begin(), found->second.end(), [](const auto& received) {
    return received.message->header.stamp.isZero();
  });
}

/// Of the scans or poses that were chosen.
template <typename Messages>
void checkStamps(const Messages& by_topic, const std::string& topic, Examination* e) {
  const std::ptrdiff_t unstamped = countUnstamped(by_topic, topic);
  if (unstamped == 0) return;
  e->error(std::to_string(unstamped) + " of " + std::to_string(by_topic.at(topic).size()) +
               " messages of " + topic + " have no stamp.",
           "Let the driver fill in header.stamp with the time of the measurement.");
}

void judgeScanRate(const TopicHealth& scans, Examination* e) {
  if (scans.messages > 1 && rateOf(scans) < kSlowScans) {
    e->warn("Scans come at " + withUnit(rateOf(scans), "Hz", 1) + " only.",
            "A voxel needs three hits to be occupied: raise the sensor's rate, or p_hit.");
  }
  if (scans.messages == 1) {
    e->warn(
        "One scan alone came on " + scans.topic + " in " + withUnit(e->seen.seconds, "s", 1) + ".",
        "Raise the sensor's rate, or look for longer with --seconds.");
  }
}

void judgePoseRate(const TopicHealth& poses, Examination* e) {
  if (poses.messages < 2) return;
  const double max_gap = e->setup.node.max_pose_gap;
  const std::string rate = withUnit(rateOf(poses), "Hz", 1);
  if (poses.interval.median > max_gap) {
    const double gap = roundedUp(kRoom * poses.interval.p95);
    e->error("Poses of " + poses.topic + " come at " + rate + ", usually " +
                 withUnit(poses.interval.median, "s") + " apart: farther than max_pose_gap, " +
                 withUnit(max_gap, "s") + ", so no scan between them is used.",
             "Publish poses more often: 20 Hz and more. Else the launch line raises max_pose_gap, "
             "and walls smear when the vehicle turns.",
             Repair::kInLaunchLine);
    e->change("max_pose_gap", plainNumber(gap));
    if (e->setup.node.max_pose_wait < gap) e->change("max_pose_wait", plainNumber(gap));
    if (e->setup.node.pose_history < gap) e->change("pose_history", plainNumber(gap));
    return;
  }
  if (poses.interval.max <= max_gap) return;
  const std::string what = "The longest gap between poses of " + poses.topic + " is " +
                           withUnit(poses.interval.max, "s") + " (max_pose_gap " +
                           withUnit(max_gap, "s") + "); they come at " + rate + ".";
  const std::string remedy =
      "Scans in such gaps are left out. Look why poses are late, or raise "
      "max_pose_gap.";
  if (static_cast<double>(poses.gaps) > kManyGaps * static_cast<double>(poses.messages)) {
    e->warn(what, remedy);
  } else {
    e->note(what, remedy);
  }
}

}  // namespace

void checkPoseRate(Examination* e) {
  checkStamps(e->seen.poses, e->setup.poses, e);
  judgePoseRate(poseTiming(*e), e);
}

void checkScanRate(Examination* e) {
  checkStamps(e->seen.images, e->setup.depth_image, e);
  checkStamps(e->seen.clouds, e->setup.points, e);
  judgeScanRate(scanTiming(e->setup, e->seen), e);
}

void checkClocks(Examination* e) {
  const TopicHealth scans = scanTiming(e->setup, e->seen), poses = poseTiming(*e);
  const bool are_stamped = countUnstamped(e->seen.images, e->setup.depth_image) == 0 &&
                           countUnstamped(e->seen.clouds, e->setup.points) == 0 &&
                           countUnstamped(e->seen.poses, e->setup.poses) == 0;
  if (scans.messages == 0 || poses.messages == 0 || !are_stamped) return;
  // The clock of receipt is the same for both and cancels out.
  const double offset = e->setup.node.time_offset;
  const double scans_later = scans.delay.median - offset - poses.delay.median;
  const std::string figures = "scans arrive " + withUnit(scans.delay.median, "s", 3) +
                              " after their stamp and poses " +
                              withUnit(poses.delay.median, "s", 3) + " after theirs";
  if (std::abs(offset + scans_later) > kMostOffset) {
    e->error("Scans and poses are stamped by different clocks: " + figures + ".",
             "Set the clocks; if one of them is simulated, stamp both by /clock.");
    return;
  }
  if (std::abs(scans_later) > kOtherClock) {
    const std::string suggestion = plainNumber(std::round((offset + scans_later) * 1e3) / 1e3);
    e->error(
        "Scans and poses are stamped by different clocks: " + figures + ".",
        "Synchronise the clocks (chrony between machines; global_time_enabled of a RealSense), "
        "or set time_offset, as the launch line does with " +
            suggestion + " s: right up to the delays on the way.",
        Repair::kInLaunchLine);
    e->change("time_offset", suggestion);
    return;
  }
  if (-scans_later > e->setup.node.max_pose_wait) {
    const double wait = roundedUp(kRoom * -scans_later);
    e->error("Poses come " + withUnit(-scans_later, "s") +
                 " later than scans of the same stamp, "
                 "which wait for max_pose_wait, " +
                 withUnit(e->setup.node.max_pose_wait, "s") + ", only: " + figures + ".",
             "Look why poses are late; the launch line raises max_pose_wait.",
             Repair::kInLaunchLine);
    e->change("max_pose_wait", plainNumber(wait));
    return;
  }
  if (std::abs(scans_later) > kNoticeable) {
    e->warn("Stamps of scans and poses are " + withUnit(std::abs(scans_later), "s", 3) +
                " apart: " + figures + ".",
            "If that is not the delay of the sensor but an error of its stamps, walls smear: then "
            "set time_offset (about " +
                plainNumber(std::round((offset + scans_later) * 1e3) / 1e3) + " s).");
  }
  if (!e->seen.live()) return;
  const double most = std::min(scans.delay.median, poses.delay.median);
  if (most > kOtherTime) {
    e->warn("All stamps are " + withUnit(most, "s", 0) + " behind the clock.",
            "If a recording is played: rosbag play --clock, with /use_sim_time set to true before "
            "any node starts. Else set the clocks of the machines.");
  } else if (most < -kFuture) {
    e->warn("Stamps lie " + withUnit(-most, "s") + " in the future.",
            "Synchronise the clocks of the machines.");
  }
}

void checkSimulatedTime(Examination* e) {
  const bool has_clock = e->seen.types.count("/clock") != 0;
  if (!e->seen.live()) {
    if (!has_clock) return;
    e->note("The bag holds /clock, as a recording of a simulation does.",
            "Play it without its /clock, or without --clock; the launch line leaves it out.");
    return;
  }
  if (e->seen.clock_messages > 0 && !e->seen.use_sim_time) {
    e->error(
        "Something publishes /clock, but /use_sim_time is not set: nodes take the machine's "
        "time for that of the messages.",
        "rosparam set /use_sim_time true, and start all nodes again.", Repair::kInLaunchLine);
  }
  if (e->seen.use_sim_time && e->seen.clock_messages == 0) {
    e->error(std::string("/use_sim_time is true, but no time comes on /clock") +
                 (has_clock ? ", although it is advertised" : "") +
                 ": time stands still for every node.",
             "Start the simulator, or rosbag play --clock; with real sensors rosparam set "
             "/use_sim_time false, and start all nodes again.");
  }
}

}  // namespace fiimap
