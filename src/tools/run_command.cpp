#include "run_command.h"

#include <rosbag/bag.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <set>
#include <stdexcept>

#include "bag_player.h"
#include "bag_topics.h"
#include "fiimap/mapper.h"
#include "fiimap/ros/map_files.h"
#include "fiimap/ros/node_config.h"
#include "fiimap/ros/parameter_sources.h"
#include "fiimap/ros/scan_decoder.h"
#include "fiimap/ros/steady_time.h"
#include "inflation_check.h"
#include "progress_bar.h"
#include "run_report.h"

namespace fiimap {
namespace {

struct Settings {
  MapperConfig mapper;
  NodeConfig node;
  BagTopics topics;
  ParameterMap given;  ///< what the user set, by name
};

Settings readSettings(const RunOptions& options) {
  Settings settings;
  if (!options.config.empty()) settings.given = parameterMapFromYaml(options.config);
  for (const std::string& setting : options.settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw std::invalid_argument("--set " + setting + ": must be name=value");
    }
    settings.given[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  ParameterMap map_settings;
  for (const std::string& name : applyParameters(settings.given, settings.topics.parameters())) {
    map_settings[name] = settings.given[name];
  }
  const std::vector<std::string> unknown =
      configure(map_settings, &settings.mapper, &settings.node);
  if (!unknown.empty()) {
    throw std::invalid_argument("unknown parameter " + unknown.front() +
                                ": see fiimap_eval parameters and fiimap_eval --help");
  }
  return settings;
}

/// Builds the map from the scans of a bag and measures each.
class MapBuilder : public ScanListener {
 public:
  MapBuilder(const MapperConfig& config, std::size_t scans, int verify_every)
      : mapper_(config), progress_(scans), verify_every_(verify_every) {}

  void onScan(const SynchronizedScan& scan) override {
    try {
      addScan(scan);
    } catch (const InputError& error) {
      onDrop(error.drop());
    }
    progress_.show(counters_.received);
  }

  void onDrop(const Drop& drop) override {
    counters_.countDrop(drop);
    warnOnce(drop.text());
  }

  void onTimeJump(const std::string& what) override {
    warnOnce(what);
    mapper_.reset();
  }

  void onWarning(const std::string& text) override { warnOnce(text); }

  /// \return the figures; the last scan is always among the verified ones.
  RunReport finish() {
    progress_.end();
    if (verify_every_ > 0 && !last_is_verified_) verify();
    if (snapshot_ == nullptr) snapshot_ = mapper_.snapshot();
    report_.finish(counters_, *snapshot_, mapper_.memoryBytes());
    return report_;
  }

  ScanCounters* counters() { return &counters_; }
  const Snapshot& snapshot() const { return *snapshot_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void addScan(const SynchronizedScan& scan) {
    ScanReport report = decoder_.integrate(scan, &mapper_);
    const SteadyTime start = std::chrono::steady_clock::now();
    snapshot_ = mapper_.snapshot();
    report.times_ms.snapshot = millisecondsSince(start);
    report_.add(report);
    ++counters_.integrated;
    last_is_verified_ = false;
    if (verify_every_ > 0 && counters_.integrated % verify_every_ == 0) verify();
  }

  void verify() {
    if (snapshot_ == nullptr) return;
    report_.addVerification(countInflationMismatches(*snapshot_));
    last_is_verified_ = true;
  }

  /// Each kind of trouble (the text up to its colon) is told once; the counters tell how often.
  void warnOnce(const std::string& text) {
    if (warned_.insert(text.substr(0, text.find(':'))).second) warnings_.push_back(text);
  }

  Mapper mapper_;
  ScanDecoder decoder_;
  ProgressBar progress_;
  int verify_every_;
  bool last_is_verified_ = false;
  std::shared_ptr<const Snapshot> snapshot_;
  ScanCounters counters_;
  RunReport report_;
  std::set<std::string> warned_;
  std::vector<std::string> warnings_;
};

nlohmann::json describe(Settings* settings) {
  nlohmann::json out;
  for (const auto& list : {mapperParameters(&settings->mapper), nodeParameters(&settings->node),
                           settings->topics.parameters()}) {
    for (const Parameter& parameter : list) out[parameter.name] = parameter.get();
  }
  return out;
}

void writeJson(const std::string& file, const nlohmann::json& json) {
  std::ofstream stream(file);
  stream << json.dump(2) << '\n';
  if (!stream.flush()) throw std::runtime_error("cannot write " + file);
}

void print(const std::vector<Parameter>& parameters) {
  for (const Parameter& p : parameters) {
    std::cout << p.name << '\t' << p.get() << '\t' << p.unit << '\t' << p.allowed << '\t'
              << p.meaning << '\n';
  }
}

}  // namespace

int run(const RunOptions& options) {
  Settings settings = readSettings(options);
  rosbag::Bag bag;
  try {
    bag.open(options.bag, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw std::invalid_argument("cannot read the bag " + options.bag + ": " + error.what());
  }
  settings.topics = chooseTopics(bag, settings.given, settings.topics, &settings.node);

  BagPlayer player(bag, settings.topics, settings.node);
  MapBuilder builder(settings.mapper, player.scans(), options.verify);
  player.play(&builder, builder.counters());
  const RunReport report = builder.finish();

  for (const std::string& warning : builder.warnings()) std::cerr << "warning: " << warning << '\n';
  std::cout << options.bag << '\n' << report.text();
  if (!options.json.empty()) {
    nlohmann::json json = report.json();
    json["bag"] = options.bag;
    json["warnings"] = builder.warnings();
    json["parameters"] = describe(&settings);
    writeJson(options.json, json);
  }
  if (!options.save.empty()) {
    writePcd(builder.snapshot(), Plane::kOccupied, options.save + "_occupied.pcd");
    writePcd(builder.snapshot(), Plane::kInflated, options.save + "_inflated.pcd");
    writeOctomap(builder.snapshot(), options.save + ".bt");
  }
  if (builder.counters()->integrated == 0) {
    std::cerr << "error: no scan could be integrated\n";
    return 1;
  }
  return report.mismatches() == 0 ? 0 : 1;
}

void printParameters() {
  MapperConfig mapper;
  NodeConfig node;
  print(mapperParameters(&mapper));
  print(nodeParameters(&node));
}

}  // namespace fiimap
