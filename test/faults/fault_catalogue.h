#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace fiimap {

/// A row of faults.yaml; see there.
struct Fault {
  std::string id;
  std::string level;
  std::vector<std::string> says;
  std::string map;
  std::vector<std::string> counters;

  bool moves(const std::string& counter) const;
};

/// Names a fault in the name of its test.
inline std::ostream& operator<<(std::ostream& stream, const Fault& fault) {
  return stream << fault.id;
}

/// The rows of a part of faults.yaml, "messages" for instance.
std::vector<Fault> faultsOf(const std::string& part);

/// What faults.yaml says of the remedy for dropped scans, by counter.
std::map<std::string, std::string> documentedRemedies();

}  // namespace fiimap
