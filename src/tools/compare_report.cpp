#include "compare_report.h"

#include <cstdio>
#include <limits>

#include "quantiles.h"

namespace fiimap {
namespace {

constexpr double kSecondsPerTick = 1e-9;  // of a stamp

/// Half-open bins of the change score; 150 and 300 are the paper's marks.
struct Bin {
  double low, high;
};
constexpr Bin kBins[] = {
    {0, 1},     {1, 25},    {25, 75},    {75, 150},
    {150, 300}, {300, 600}, {600, 1200}, {1200, std::numeric_limits<double>::infinity()},
};

nlohmann::json toJson(const Quantiles& q) {
  return {{"median_us", q.median}, {"p95_us", q.p95}, {"max_us", q.max}};
}

double meanOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / values.size();
}

nlohmann::json methodsOf(const UpdateComparison& comparison) {
  nlohmann::json list = nlohmann::json::array();
  for (const MethodTimes& method : comparison.times()) {
    nlohmann::json json = toJson(quantilesOf(method.times_us));
    json["method"] = method.name;
    json["what"] = method.inflation_only ? "inflation" : "map";
    json["mean_us"] = meanOf(method.times_us);
    list.push_back(json);
  }
  return list;
}

nlohmann::json binsOf(const UpdateComparison& comparison) {
  nlohmann::json list = nlohmann::json::array();
  for (const Bin& bin : kBins) {
    nlohmann::json json = {{"from", bin.low}};
    if (bin.high < std::numeric_limits<double>::infinity()) json["below"] = bin.high;
    std::size_t updates = 0;
    for (const MethodTimes& method : comparison.times()) {
      std::vector<double> times_us;
      for (std::size_t i = 0; i < method.times_us.size(); ++i) {
        const double score = comparison.changeScores()[i];
        if (score >= bin.low && score < bin.high) times_us.push_back(method.times_us[i]);
      }
      updates = times_us.size();
      json["median_us"][method.name] = quantilesOf(times_us).median;
    }
    json["updates"] = updates;
    if (updates > 0) list.push_back(json);
  }
  return list;
}

}  // namespace

nlohmann::json summaryOf(const UpdateComparison& comparison) {
  nlohmann::json json;
  json["clock"] = "CPU time of the thread";
  json["updates"] = comparison.changeScores().size();
  const Quantiles scores = quantilesOf(comparison.changeScores());
  json["change_score"] = {{"median", scores.median}, {"p95", scores.p95}, {"max", scores.max}};
  json["methods"] = methodsOf(comparison);
  json["by_change_score"] = binsOf(comparison);
  return json;
}

std::string toText(const UpdateComparison& comparison) {
  std::string text =
      std::to_string(comparison.changeScores().size()) +
      " updates; CPU time of the thread\n"
      "method            what          mean us   median us      p95 us      max us\n";
  for (const nlohmann::json& method : methodsOf(comparison)) {
    char line[128];
    std::snprintf(line, sizeof(line), "%-17s %-9s %11.1f %11.1f %11.1f %11.1f\n",
                  method["method"].get<std::string>().c_str(),
                  method["what"].get<std::string>().c_str(), method["mean_us"].get<double>(),
                  method["median_us"].get<double>(), method["p95_us"].get<double>(),
                  method["max_us"].get<double>());
    text += line;
  }
  return text;
}

std::string toCsv(const UpdateComparison& comparison) {
  std::string text = "update,stamp,change_score";
  for (const MethodTimes& method : comparison.times()) text += "," + method.name + "_us";
  text += '\n';
  for (std::size_t i = 0; i < comparison.changeScores().size(); ++i) {
    char row[96];
    std::snprintf(row, sizeof(row), "%zu,%.6f,%.0f", i, comparison.stampsNs()[i] * kSecondsPerTick,
                  comparison.changeScores()[i]);
    text += row;
    for (const MethodTimes& method : comparison.times()) {
      std::snprintf(row, sizeof(row), ",%.3f", method.times_us[i]);
      text += row;
    }
    text += '\n';
  }
  return text;
}

}  // namespace fiimap
