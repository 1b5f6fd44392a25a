// Runs our map and the baselines over recorded frames, taking turns in one thread, and writes the
// times of every frame as JSON for benchmark/report.py.

#include <boost/program_options.hpp>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "agreement.h"
#include "experiments/experiments.h"
#include "recording.h"
#include "samples.h"

namespace {

namespace po = boost::program_options;
using fiimap::bench::Recording;
using fiimap::bench::Samples;

using Experiment = std::function<void(const Recording&, Samples*)>;

const std::vector<std::pair<std::string, Experiment>>& experiments() {
  static const std::vector<std::pair<std::string, Experiment>> list = {
      {"pipeline", fiimap::bench::measurePipelines}, {"inflation", fiimap::bench::measureInflation},
      {"growth", fiimap::bench::measureGrowth},      {"worst", fiimap::bench::measureWorstCases},
      {"reading", fiimap::bench::measureReading},
  };
  return list;
}

Experiment find(const std::string& name) {
  for (const auto& [known, experiment] : experiments()) {
    if (known == name) return experiment;
  }
  throw std::invalid_argument("no experiment is called " + name);
}

struct Options {
  std::vector<std::string> bags;
  std::vector<std::string> experiments;
  std::size_t frames = 600;
  std::string json;
  bool check = false;
  std::string run;
  double resolution = 0.1;  // m
};

bool parse(int argc, char** argv, Options* options) {
  po::options_description description("fiimap_compare --bag NAME=FILE [options]");
  auto add = description.add_options();
  add("help", "this text");
  add("bag", po::value(&options->bags)->required(), "a recording; may be repeated");
  add("experiment", po::value(&options->experiments),
      "pipeline, inflation, growth, worst or reading; may be repeated; default: all");
  add("frames", po::value(&options->frames)->default_value(options->frames),
      "use the first frames of each recording only");
  add("json", po::value(&options->json), "where to write the times");
  add("check", po::bool_switch(&options->check),
      "measure nothing; fail when the methods make different maps");
  add("run", po::value(&options->run),
      "measure nothing; run one method's pipeline: fiimap, ego, ego_invalid_far, per_pixel, "
      "octomap");
  add("resolution", po::value(&options->resolution)->default_value(options->resolution),
      "of --run, metres");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, description), values);
  if (values.count("help") > 0) {
    std::cout << description;
    return false;
  }
  po::notify(values);
  if (options->experiments.empty()) {
    for (const auto& [name, experiment] : experiments()) options->experiments.push_back(name);
  }
  return true;
}

void write(const Samples& samples, const std::string& file) {
  std::ofstream stream(file);
  stream << samples.json() << '\n';
  if (!stream.flush()) throw std::runtime_error("cannot write " + file);
}

void measure(const Recording& recording, const Options& options, Samples* samples) {
  for (const std::string& name : options.experiments) {
    std::cerr << recording.name << ": " << name << ", " << recording.frames.size() << " frames\n";
    find(name)(recording, samples);
    // After each one: who interrupts a long run keeps what it has measured.
    if (!options.json.empty()) write(*samples, options.json);
  }
}

int run(const Options& options) {
  Samples samples;
  bool agree = true;
  for (const std::string& bag : options.bags) {
    const Recording recording = fiimap::bench::loadRecording(bag, options.frames);
    if (options.check) {
      agree &= fiimap::bench::checkAgreement(recording);
    } else if (!options.run.empty()) {
      fiimap::bench::runPipelineOnce(recording, options.run, options.resolution);
    } else {
      measure(recording, options, &samples);
    }
  }
  return agree ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    return parse(argc, argv, &options) ? run(options) : 0;
  } catch (const std::exception& error) {
    std::cerr << "fiimap_compare: " << error.what() << '\n';
    return 1;
  }
}
