#include "recorded_trajectory.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace fiimap {
namespace {

constexpr double kQuaternionTolerance = 1e-3;  // of its length

/// Times have 6 decimals: a double of a present date would not hold more.
std::int64_t toNanoseconds(double seconds) { return std::llround(seconds * 1e6) * 1000; }

/// \return false when the words are no scan.
bool parse(const std::string& line, RecordedScan* scan) {
  std::istringstream words(line);
  double stamp, recorded;
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
  words >> stamp >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w() >> recorded;
  if (!words || std::abs(q.norm() - 1.0) > kQuaternionTolerance || stamp <= 0.0) return false;
  scan->stamp_ns = toNanoseconds(stamp);
  scan->recorded_ns = toNanoseconds(recorded);
  scan->T_W_V.translation() = t;
  scan->T_W_V.linear() = q.normalized().toRotationMatrix();
  return true;
}

}  // namespace

std::vector<RecordedScan> readTrajectory(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::invalid_argument("cannot read " + file);
  std::vector<RecordedScan> scans;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    const std::string place = file + ", line " + std::to_string(++number) + ": ";
    if (line.empty() || line[0] == '#') continue;
    RecordedScan scan;
    if (!parse(line, &scan)) {
      throw std::invalid_argument(place + "must be stamp tx ty tz qx qy qz qw time-of-recording");
    }
    if (scan.recorded_ns < scan.stamp_ns) {
      throw std::invalid_argument(place + "recorded before its stamp");
    }
    if (!scans.empty() &&
        (scan.stamp_ns <= scans.back().stamp_ns || scan.recorded_ns <= scans.back().recorded_ns)) {
      throw std::invalid_argument(place + "times must ascend");
    }
    scans.push_back(scan);
  }
  if (scans.empty()) throw std::invalid_argument(file + " holds no scan");
  return scans;
}

Eigen::Isometry3d poseAt(const std::vector<RecordedScan>& scans, std::int64_t stamp_ns) {
  const auto after =
      std::upper_bound(scans.begin(), scans.end(), stamp_ns,
                       [](std::int64_t t, const RecordedScan& scan) { return t < scan.stamp_ns; });
  if (after == scans.begin()) return scans.front().T_W_V;
  if (after == scans.end()) return scans.back().T_W_V;
  const RecordedScan& before = *std::prev(after);
  const double share = static_cast<double>(stamp_ns - before.stamp_ns) /
                       static_cast<double>(after->stamp_ns - before.stamp_ns);
  const Eigen::Quaterniond from(before.T_W_V.linear()), to(after->T_W_V.linear());
  Eigen::Isometry3d T_W_V = Eigen::Isometry3d::Identity();
  T_W_V.linear() = from.slerp(share, to).toRotationMatrix();
  T_W_V.translation() =
      (1.0 - share) * before.T_W_V.translation() + share * after->T_W_V.translation();
  return T_W_V;
}

}  // namespace fiimap
