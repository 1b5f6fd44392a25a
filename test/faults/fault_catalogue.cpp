#include "fault_catalogue.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace fiimap {
namespace {

YAML::Node catalogue() { return YAML::LoadFile(FIIMAP_FAULTS_FILE); }

}  // namespace

bool Fault::moves(const std::string& counter) const {
  return std::find(counters.begin(), counters.end(), counter) != counters.end();
}

std::vector<Fault> faultsOf(const std::string& part) {
  std::vector<Fault> faults;
  for (const YAML::Node& section : catalogue()[part]) {
    for (const YAML::Node& row : section["faults"]) {
      Fault fault;
      fault.id = row["id"].as<std::string>();
      fault.level = row["level"].as<std::string>("");
      fault.says = row["says"].as<std::vector<std::string>>();
      fault.map = row["map"].as<std::string>("");
      fault.counters = row["counters"].as<std::vector<std::string>>(std::vector<std::string>());
      faults.push_back(fault);
    }
  }
  return faults;
}

std::map<std::string, std::string> documentedRemedies() {
  return catalogue()["remedies"].as<std::map<std::string, std::string>>();
}

}  // namespace fiimap
