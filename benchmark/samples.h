#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fiimap::bench {

/// What was measured of one method in one situation, frame by frame, for benchmark/report.py:
/// microseconds, unless the experiment's name says otherwise.
struct Series {
  std::string experiment;
  std::string recording;
  std::string method;
  nlohmann::json setting;  ///< what was varied: resolution (m), reach (voxels), ...
  std::vector<double> values;
};

/// All that one run measured.
class Samples {
 public:
  void add(const Series& series) {
    list_.push_back({{"experiment", series.experiment},
                     {"recording", series.recording},
                     {"method", series.method},
                     {"setting", series.setting},
                     {"values", series.values}});
  }
  const nlohmann::json& json() const { return list_; }

 private:
  nlohmann::json list_ = nlohmann::json::array();
};

}  // namespace fiimap::bench
