#include "health/health_command.h"

#include <cstdio>
#include <iostream>

#include "health/topic_health.h"
#include "reading_projector.h"
#include "scan_evaluator.h"

namespace fiimap {
namespace {

constexpr double kStampUnit = 1e-9;  // s
constexpr int kReadingStep = 4;      // pixels

/// What the scans that found a pose are like.
class ScanHealth : public ScanEvaluator {
 public:
  explicit ScanHealth(const MapperConfig& config) : projector_(config, kReadingStep) {}

  nlohmann::json json() const {
    const auto share = [&](std::size_t part) {
      return readings_.total == 0 ? 0.0 : static_cast<double>(part) / readings_.total;
    };
    const Quantiles gap = quantilesOf(pose_gaps_);
    const Quantiles speed = quantilesOf(speeds_);
    nlohmann::json json = toJson(counters());
    json["warnings"] = warnings();
    json["readings"] = {{"returns", share(readings_.returns)},
                        {"invalid", share(readings_.invalid)},
                        {"too_near", share(readings_.too_near)},
                        {"too_far", share(readings_.too_far)},
                        {"infinite", share(readings_.infinite)}};
    json["pose_gap_s"] = {{"median", gap.median}, {"p95", gap.p95}, {"max", gap.max}};
    json["speed_m_s"] = {{"median", speed.median}, {"p95", speed.p95}, {"max", speed.max}};
    json["path_m"] = path_;
    return json;
  }

 private:
  void addScan(const SynchronizedScan& scan, std::size_t /*index*/) override {
    RangeData range;
    const ReadingCount count = projector_.project(scan, &range);
    readings_.total += count.total;
    readings_.returns += count.returns;
    readings_.invalid += count.invalid;
    readings_.too_near += count.too_near;
    readings_.too_far += count.too_far;
    readings_.infinite += count.infinite;
    pose_gaps_.push_back(scan.pose_gap);
    if (has_last_) {
      const double step = (scan.pose.vehicle_W - last_.vehicle_W).norm();
      const double seconds = (scan.pose.stamp_ns - last_.stamp_ns) * kStampUnit;
      path_ += step;
      if (seconds > 0.0) speeds_.push_back(step / seconds);
    }
    last_ = scan.pose;
    has_last_ = true;
  }

  void forget() override { has_last_ = false; }

  ReadingProjector projector_;
  ReadingCount readings_;
  std::vector<double> pose_gaps_;
  std::vector<double> speeds_;
  double path_ = 0.0;  // m
  ScanPose last_;
  bool has_last_ = false;
};

std::vector<std::string> topicsOf(const EvaluationInput& input) {
  std::vector<std::string> topics;
  const std::vector<SensorConfig> sensors = input.node().allSensors();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const SensorBagTopics& own = input.topics().sensors[i];
    topics.push_back(own.scans(sensors[i].sensor));
    if (sensors[i].sensor == SensorKind::kDepth) topics.push_back(own.camera_info_topic);
  }
  topics.push_back(input.topics().pose_topic.empty() ? "/tf" : input.topics().pose_topic);
  return topics;
}

void print(const nlohmann::json& json, const std::vector<TopicHealth>& topics) {
  std::cout << toText(topics) << "scans " << json["scans"] << ", integrated " << json["integrated"]
            << "; path " << json["path_m"].get<double>() << " m, at most "
            << json["speed_m_s"]["max"].get<double>() << " m/s; longest gap between poses "
            << json["pose_gap_s"]["max"].get<double>() << " s\n";
  for (const auto& [name, share] : json["readings"].items()) {
    char line[64];
    std::snprintf(line, sizeof(line), "  %-9s %.4f of the readings\n", name.c_str(),
                  share.get<double>());
    std::cout << line;
  }
}

}  // namespace

int examineRecording(const HealthOptions& options) {
  const EvaluationInput input(options.input);
  ScanHealth scans(input.mapper());
  scans.play(input);
  std::vector<TopicHealth> topics;
  for (const std::string& topic : topicsOf(input)) topics.push_back(healthOf(input.bag(), topic));

  scans.printWarnings();
  nlohmann::json json = scans.json();
  json["topics"] = nlohmann::json::array();
  for (const TopicHealth& topic : topics) json["topics"].push_back(toJson(topic));
  print(json, topics);
  input.writeJson(json);
  return 0;
}

}  // namespace fiimap
