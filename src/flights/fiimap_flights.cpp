// Flies many closed-loop flights and prints how they ended: one line for each, and a summary for
// each combination of the settings that were varied.

#include <algorithm>
#include <boost/program_options.hpp>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "closed_loop.h"
#include "progress_bar.h"
#include "quantiles.h"

namespace {

namespace po = boost::program_options;
using fiimap::FlightOutcome;
using fiimap::FlightSettings;

constexpr double kClearanceBin = 0.05;  // m

constexpr char kUsage[] =
    "Closed-loop flights without ROS: simulator, map and planner in one thread, in simulated time. "
    "The\n"
    "same settings give the same flight.\n\n"
    "  fiimap_flights --seeds 20 --vary planner.layer=inflated,raw --vary planner.max_speed=2,4\n\n"
    "PART is simulator, map or planner.\n\n";

struct Options {
  std::vector<std::string> files, settings, variations;
  int seeds = 1;
  double time_limit = 300.0;
  std::string json;
  bool resume = false;
};

po::options_description describe(Options* options) {
  po::options_description all("Options");
  all.add_options()("help,h", "this text")(
      "config", po::value(&options->files)->value_name("PART=FILE")->composing(),
      "parameters (YAML, as for the nodes); may be repeated")(
      "set", po::value(&options->settings)->value_name("PART.NAME=VALUE")->composing(),
      "a parameter, after those of files; may be repeated")(
      "vary", po::value(&options->variations)->value_name("PART.NAME=V1,V2,...")->composing(),
      "fly with each of these values; may be repeated: then with all combinations")(
      "seeds", po::value(&options->seeds)->value_name("N"),
      "fly in worlds 1 to N of each combination (1)")(
      "time-limit", po::value(&options->time_limit)->value_name("S"),
      "of a flight, simulated time (300)")("json", po::value(&options->json)->value_name("FILE"),
                                           "write the figures of all flights to this file")(
      "resume", po::bool_switch(&options->resume),
      "keep the flights that the file of --json holds, by an interrupted run with the same "
      "options");
  return all;
}

FlightSettings baseSettings(const Options& options) {
  FlightSettings settings;
  settings.time_limit = options.time_limit;
  for (const std::string& file : options.files) {
    const std::size_t equals = file.find('=');
    if (equals == std::string::npos) {
      throw std::invalid_argument("--config " + file + ": must be PART=FILE");
    }
    applyFile(file.substr(0, equals), file.substr(equals + 1), &settings);
  }
  for (const std::string& setting : options.settings) applySetting(setting, &settings);
  return settings;
}

/// All combinations of what is varied, each a list of settings.
std::vector<std::vector<std::string>> combinations(const std::vector<std::string>& variations) {
  std::vector<std::vector<std::string>> all{{}};
  for (const std::string& variation : variations) {
    const std::size_t equals = variation.find('=');
    if (equals == std::string::npos) {
      throw std::invalid_argument("--vary " + variation + ": must be PART.NAME=V1,V2,...");
    }
    std::vector<std::vector<std::string>> longer;
    for (const auto& combination : all) {
      std::istringstream values(variation.substr(equals + 1));
      for (std::string value; std::getline(values, value, ',');) {
        longer.push_back(combination);
        longer.back().push_back(variation.substr(0, equals + 1) + value);
      }
    }
    all = longer;
  }
  return all;
}

/// How many of a flight's clearances are in [0, kBin), [kBin, 2 kBin), ... m.
std::vector<int> histogramOf(const std::vector<double>& clearances_m) {
  std::vector<int> counts;
  for (const double clearance : clearances_m) {
    const auto bin = static_cast<std::size_t>(std::max(0.0, clearance) / kClearanceBin);
    if (bin >= counts.size()) counts.resize(bin + 1);
    ++counts[bin];
  }
  return counts;
}

/// Why a flight did not reach its goal; empty: it did.
std::string whyNot(const FlightOutcome& outcome) {
  if (outcome.reached) return "";
  if (outcome.planner.state == fiimap::FlightState::kNoPath) return outcome.planner.reason;
  return "its time was over";
}

nlohmann::json toJson(const FlightOutcome& outcome) {
  const fiimap::Quantiles update = fiimap::quantilesOf(outcome.update_ms);
  const fiimap::Quantiles planning = fiimap::quantilesOf(outcome.planning_ms);
  return {{"reached", outcome.reached},
          {"reason", whyNot(outcome)},
          {"seconds", outcome.seconds},
          {"path_length_m", outcome.truth.path_length},
          {"least_clearance_m", outcome.truth.least_clearance},
          {"clearance_bin_m", kClearanceBin},
          {"clearance_histogram", histogramOf(outcome.clearances_m)},
          {"collisions", outcome.truth.collisions},
          {"plans", outcome.planner.plans},
          {"plan_failures", outcome.planner.failures},
          {"scans", outcome.update_ms.size()},
          {"map_update_ms_median", update.median},
          {"map_update_ms_p95", update.p95},
          {"planning_ms_median", planning.median},
          {"planning_ms_p95", planning.p95},
          {"simulation_cpu_share", outcome.cpu_s.simulation / outcome.seconds},
          {"mapping_cpu_share", outcome.cpu_s.mapping / outcome.seconds},
          {"planning_cpu_share", outcome.cpu_s.planning / outcome.seconds}};
}

std::string nameOf(const std::vector<std::string>& combination) {
  std::string name;
  for (const std::string& setting : combination) name += (name.empty() ? "" : " ") + setting;
  return name.empty() ? "as set" : name;
}

double median(const std::vector<nlohmann::json>& flights, const std::string& key) {
  std::vector<double> values;
  for (const nlohmann::json& flight : flights) values.push_back(flight[key].get<double>());
  return fiimap::quantilesOf(values).median;
}

/// The first rows of the summary, and one of its rows. Clearances: least, and median of the
/// flights' least ones; shares: CPU time by simulated time, median of the flights.
void printSummaryHead() {
  std::cout << "| settings | flights | reached | collided | least clearance m | median of least m "
               "| time s | way m | map ms | plan ms | simulation % | mapping % | planning % |\n"
               "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
}

void printSummary(const std::string& name, const std::vector<nlohmann::json>& flights) {
  constexpr double kPercent = 100.0;
  int reached = 0, collided = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const nlohmann::json& flight : flights) {
    reached += flight["reached"].get<bool>() ? 1 : 0;
    collided += flight["collisions"].get<int>() > 0 ? 1 : 0;
    least = std::min(least, flight["least_clearance_m"].get<double>());
  }
  std::cout << "| " << name << " | " << flights.size() << " | " << reached << " | " << collided
            << " | " << least;
  for (const char* key : {"least_clearance_m", "seconds", "path_length_m", "map_update_ms_median",
                          "planning_ms_median"}) {
    std::cout << " | " << median(flights, key);
  }
  for (const char* key : {"simulation_cpu_share", "mapping_cpu_share", "planning_cpu_share"}) {
    std::cout << " | " << kPercent * median(flights, key);
  }
  std::cout << " |\n";
}

/// The file is the old one or the new one at any time. Does nothing without a path.
void write(const nlohmann::json& report, const std::string& path) {
  if (path.empty()) return;
  const std::string unfinished = path + ".new";
  std::ofstream file(unfinished);
  file << report.dump(2) << std::endl;
  file.close();
  if (!file || std::rename(unfinished.c_str(), path.c_str()) != 0) {
    throw std::runtime_error("cannot write " + path);
  }
}

nlohmann::json fly(const FlightSettings& base, const std::vector<std::string>& combination,
                   int seed) {
  FlightSettings settings = base;
  settings.simulator.world.seed = seed;
  for (const std::string& setting : combination) applySetting(setting, &settings);
  nlohmann::json flight = toJson(fiimap::flyClosedLoop(settings));
  flight["settings"] = combination;
  flight["seed"] = seed;
  return flight;
}

/// The flights that an interrupted run left in the file; none: it left no file.
nlohmann::json flownBefore(const Options& options) {
  std::ifstream file(options.json);
  if (!options.resume || !file) return nlohmann::json::array();
  const nlohmann::json report = nlohmann::json::parse(file, nullptr, false);
  if (!report.is_array())
    throw std::invalid_argument("--resume: " + options.json + " holds no flights");
  return report;
}

/// The flight of a report with these settings in this world; null: there is none.
const nlohmann::json* find(const nlohmann::json& report,
                           const std::vector<std::string>& combination, int seed) {
  for (const nlohmann::json& flight : report) {
    if (flight.at("seed") == seed && flight.at("settings") == combination) return &flight;
  }
  return nullptr;
}

void flyAll(const Options& options) {
  const FlightSettings base = baseSettings(options);
  const auto all = combinations(options.variations);
  fiimap::ProgressBar progress(all.size() * options.seeds);
  std::size_t done = 0;
  nlohmann::json report = flownBefore(options);
  write(report, options.json);  // so that a bad path is known before the flights
  std::vector<std::vector<nlohmann::json>> flights(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (int seed = 1; seed <= options.seeds; ++seed) {
      if (find(report, all[k], seed) == nullptr) {
        report.push_back(fly(base, all[k], seed));
        write(report, options.json);  // so that an interrupted run keeps its flights
      }
      flights[k].push_back(*find(report, all[k], seed));
      progress.show(++done);
    }
  }
  progress.end();
  std::cout << std::fixed << std::setprecision(2);
  printSummaryHead();
  for (std::size_t k = 0; k < all.size(); ++k) printSummary(nameOf(all[k]), flights[k]);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    const po::options_description description = describe(&options);
    po::variables_map values;
    po::store(po::parse_command_line(argc, argv, description), values);
    po::notify(values);
    if (values.count("help") > 0) {
      std::cout << kUsage << description;
      return 0;
    }
    flyAll(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
