#include "run_command.h"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "fiimap/mapper.h"
#include "fiimap/ros/map_files.h"
#include "fiimap/ros/scan_decoder.h"
#include "fiimap/ros/steady_time.h"
#include "inflation_check.h"
#include "output_file.h"
#include "run_report.h"
#include "scan_evaluator.h"

namespace fiimap {
namespace {

/// Builds the map from the scans of a bag and measures each.
class MapBuilder : public ScanEvaluator {
 public:
  MapBuilder(const MapperConfig& config, int verify_every)
      : mapper_(config), verify_every_(verify_every) {}

  /// \return the figures; the last scan is always among the verified ones.
  RunReport finish() {
    if (verify_every_ > 0 && !last_is_verified_) verify();
    if (snapshot_ == nullptr) snapshot_ = mapper_.snapshot();
    report_.finish(counters(), *snapshot_, mapper_.memoryBytes());
    return report_;
  }

  const Snapshot& snapshot() const { return *snapshot_; }

 private:
  void addScan(const SynchronizedScan& scan, std::size_t /*index*/) override {
    ScanReport report = decoder_.integrate(scan, &mapper_);
    const SteadyTime start = std::chrono::steady_clock::now();
    snapshot_ = mapper_.snapshot();
    report.times_ms.snapshot = millisecondsSince(start);
    report_.add(report);
    last_is_verified_ = false;
    if (verify_every_ > 0 && ++since_verified_ == verify_every_) verify();
  }

  void forget() override { mapper_.reset(); }

  void verify() {
    if (snapshot_ == nullptr) return;
    report_.addVerification(countInflationMismatches(*snapshot_));
    last_is_verified_ = true;
    since_verified_ = 0;
  }

  Mapper mapper_;
  ScanDecoder decoder_;
  int verify_every_;
  int since_verified_ = 0;
  bool last_is_verified_ = false;
  std::shared_ptr<const Snapshot> snapshot_;
  RunReport report_;
};

/// Writes all files of the map, or none.
void save(const Snapshot& map, const std::string& prefix) {
  const std::string occupied = prefix + "_occupied.pcd", inflated = prefix + "_inflated.pcd";
  const std::string octomap = prefix + ".bt";
  try {
    writePcd(map, Plane::kOccupied, occupied);
    writePcd(map, Plane::kInflated, inflated);
    writeOctomap(map, octomap);
  } catch (const std::exception& error) {
    for (const std::string& file : {occupied, inflated, octomap}) std::remove(file.c_str());
    throw std::runtime_error("cannot save the map as " + prefix + ": " + error.what());
  }
}

void print(const std::vector<Parameter>& parameters) {
  for (const Parameter& p : parameters) {
    std::cout << p.name << '\t' << p.get() << '\t' << p.unit << '\t' << p.allowed << '\t'
              << p.meaning << '\t' << (p.tunable ? "tunable" : "") << '\n';
  }
}

}  // namespace

int run(const RunOptions& options) {
  if (options.verify < 0) throw std::invalid_argument("--verify must be at least 1");
  const EvaluationInput input(options.input);
  if (!options.save.empty()) checkWritable(options.save + ".bt");
  MapBuilder builder(input.mapper(), options.verify);
  builder.play(input);
  const RunReport report = builder.finish();

  builder.printWarnings();
  std::cout << options.input.bag << '\n' << report.text();
  nlohmann::json json = report.json();
  json["warnings"] = builder.warnings();
  for (std::size_t i = 0; i < input.node().sensors.size(); ++i) {
    json["sensors"][input.node().sensors[i].name] = toJson(builder.counters().sensors[i]);
  }
  if (!options.save.empty()) save(builder.snapshot(), options.save);
  input.writeJson(json);
  return report.mismatches() == 0 ? 0 : 1;
}

void printParameters() {
  MapperConfig mapper;
  NodeConfig node;
  print(mapperParameters(&mapper));
  print(nodeParameters(&node));
}

}  // namespace fiimap
