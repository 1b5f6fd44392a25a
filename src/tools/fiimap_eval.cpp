#include <boost/program_options.hpp>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "accuracy_command.h"
#include "bandwidth_command.h"
#include "compare_command.h"
#include "health/health_command.h"
#include "report_command.h"
#include "run_command.h"
#include "sweep_command.h"
#include "truth_command.h"

namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "Offline evaluation of fiimap on recorded data\n\n"
    "  fiimap_eval run BAG [options]       builds the map of a bag as the nodelet would, and "
    "prints\n"
    "                                      what it cost\n"
    "  fiimap_eval health BAG [options]    tells rates, gaps and delays of the recording, and "
    "what\n"
    "                                      its readings are\n"
    "  fiimap_eval accuracy BAG [options]  holds scans out and compares them with the map of the\n"
    "                                      others\n"
    "  fiimap_eval sweep BAG [options]     times inflation by resolution, radius, shape and "
    "method\n"
    "  fiimap_eval compare BAG [options]   times every update with this map and with others, in "
    "turns\n"
    "  fiimap_eval truth BAG [options]     compares the map with the exact scene of a synthetic\n"
    "                                      recording\n"
    "  fiimap_eval bandwidth BAG [options] tells what the clouds and ~changes take on a link\n"
    "  fiimap_eval report BAG... -o DIR    all of these, as a page to look at; --help tells more\n"
    "  fiimap_eval parameters              lists the parameters of map and node: name, default,\n"
    "                                      unit, allowed values, meaning, whether tunable\n\n"
    "Topics that are not found by type are set like parameters: depth_topic, camera_info_topic, "
    "points_topic, pose_topic.\n\n";

po::options_description describe(const std::string& title, fiimap::InputOptions* input) {
  po::options_description options(title);
  options.add_options()("help,h", "this text")("config",
                                               po::value(&input->config)->value_name("FILE"),
                                               "parameters (YAML, as for the nodelet)")(
      "set", po::value(&input->settings)->value_name("NAME=VALUE")->composing(),
      "a parameter, after those of the file; may be repeated")(
      "json", po::value(&input->json)->value_name("FILE"), "write the figures to this file");
  return options;
}

po::options_description describe(fiimap::RunOptions* run) {
  po::options_description options = describe("Options of run", &run->input);
  options.add_options()(
      "save", po::value(&run->save)->value_name("PREFIX"),
      "write the final map to PREFIX_occupied.pcd, PREFIX_inflated.pcd and PREFIX.bt")(
      "verify", po::value(&run->verify)->value_name("N"),
      "compare the inflated layer with brute force at every N-th scan and at the last");
  return options;
}

po::options_description describe(fiimap::HealthOptions* health) {
  return describe("Options of health", &health->input);
}

po::options_description describe(fiimap::AccuracyOptions* accuracy) {
  po::options_description options = describe("Options of accuracy", &accuracy->input);
  options.add_options()("resolutions",
                        po::value(&accuracy->resolutions)->multitoken()->value_name("M..."),
                        "voxel sizes, one map each; default: that of the configuration")(
      "split", po::value(&accuracy->split)->value_name("FILE"),
      "lines \"INDEX build\" or \"INDEX test\": which scans are held out")(
      "folds", po::value(&accuracy->folds)->value_name("N"),
      "hold out each of N folds in turn; without it, the last of 10 only")(
      "fold", po::value(&accuracy->fold)->value_name("K"),
      "hold out the scans with index % N == K only")(
      "held-out-step", po::value(&accuracy->held_out_step)->value_name("PIXELS"),
      "look at every n-th pixel of every n-th row of the held-out scans (4)")(
      "octomap", po::bool_switch(&accuracy->octomap), "the same with OctoMap, for comparison")(
      "csv", po::bool_switch(&accuracy->csv), "print the table as CSV");
  return options;
}

po::options_description describe(fiimap::SweepOptions* sweep) {
  po::options_description options = describe("Options of sweep", &sweep->input);
  options.add_options()("resolutions",
                        po::value(&sweep->resolutions)->multitoken()->value_name("M..."),
                        "voxel sizes (0.2 0.1 0.05)")(
      "reaches", po::value(&sweep->reaches)->multitoken()->value_name("L..."),
      "how far to inflate, voxels (1 to 10)")(
      "methods", po::value(&sweep->methods)->multitoken()->value_name("NAME..."),
      "of incremental, bfs6, bfs18, bfs26, batch, byte_batch; default: all")(
      "shapes", po::value(&sweep->shapes)->multitoken()->value_name("NAME..."),
      "of ball, cube, diamond (ball)")("seconds", po::value(&sweep->seconds)->value_name("S"),
                                       "end a series after this much CPU time (5)")(
      "csv", po::bool_switch(&sweep->csv), "print the table as CSV");
  return options;
}

po::options_description describe(fiimap::CompareOptions* compare) {
  po::options_description options = describe("Options of compare", &compare->input);
  options.add_options()(
      "methods", po::value(&compare->methods)->multitoken()->value_name("NAME..."),
      "inflation alone: incremental, bfs6, bfs18, bfs26, batch, byte_batch; whole "
      "maps: fiimap, ego, ego_invalid_far, per_pixel, octomap (incremental bfs6 "
      "byte_batch fiimap ego octomap)")("csv", po::bool_switch(&compare->csv),
                                        "print a row for every update as CSV");
  return options;
}

po::options_description describe(fiimap::TruthOptions* truth) {
  po::options_description options = describe("Options of truth", &truth->input);
  options.add_options()("scene", po::value(&truth->scene)->value_name("FILE"),
                        "the exact scene (data/README.md)")(
      "resolutions", po::value(&truth->resolutions)->multitoken()->value_name("M..."),
      "voxel sizes, one map each; default: that of the configuration")(
      "snapshots", po::value(&truth->snapshots)->value_name("N"),
      "compare the map this often, evenly over the recording (10)")(
      "voxels", po::value(&truth->voxels)->value_name("FILE"),
      "write the occupied voxels of the last map with their distance from the surface (CSV)")(
      "csv", po::bool_switch(&truth->csv), "print the table as CSV");
  return options;
}

po::options_description describe(fiimap::BandwidthOptions* bandwidth) {
  return describe("Options of bandwidth", &bandwidth->input);
}

/// Reads what follows the command.
/// \return false when help was asked for, and given.
bool parse(int argc, char** argv, const po::options_description& visible,
           fiimap::InputOptions* input) {
  po::options_description all;
  all.add(visible).add_options()("command", po::value<std::string>())("bag",
                                                                      po::value(&input->bag));
  po::positional_options_description positions;
  positions.add("command", 1).add("bag", 1);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional(positions).run(), values);
  po::notify(values);
  if (values.count("help") > 0) {
    std::cout << kUsage << visible;
    return false;
  }
  if (input->bag.empty()) throw std::invalid_argument("no bag is given; see fiimap_eval --help");
  return true;
}

template <typename Options>
int runCommand(int argc, char** argv, int (*command)(const Options&)) {
  Options options;
  const po::options_description visible = describe(&options);
  return parse(argc, argv, visible, &options.input) ? command(options) : 0;
}

int printHelp() {
  fiimap::RunOptions run;
  fiimap::HealthOptions health;
  fiimap::AccuracyOptions accuracy;
  fiimap::SweepOptions sweep;
  fiimap::CompareOptions compare;
  fiimap::TruthOptions truth;
  fiimap::BandwidthOptions bandwidth;
  std::cout << kUsage << describe(&run) << '\n'
            << describe(&health) << '\n'
            << describe(&accuracy) << '\n'
            << describe(&sweep) << '\n'
            << describe(&compare) << '\n'
            << describe(&truth) << '\n'
            << describe(&bandwidth);
  return 0;
}

int dispatch(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "run") return runCommand(argc, argv, fiimap::run);
  if (command == "bandwidth") return runCommand(argc, argv, fiimap::measureBandwidth);
  if (command == "accuracy") return runCommand(argc, argv, fiimap::evaluateAccuracy);
  if (command == "health") return runCommand(argc, argv, fiimap::examineRecording);
  if (command == "report") return fiimap::makeReport(argc - 2, argv + 2);
  if (command == "sweep") return runCommand(argc, argv, fiimap::sweepInflation);
  if (command == "compare") return runCommand(argc, argv, fiimap::compareMethods);
  if (command == "truth") return runCommand(argc, argv, fiimap::evaluateTruth);
  if (command == "--help" || command == "-h") return printHelp();
  if (command == "parameters") {
    fiimap::printParameters();
    return 0;
  }
  throw std::invalid_argument(
      "the command must be run, health, accuracy, sweep, compare, truth, bandwidth, report or "
      "parameters; see fiimap_eval --help");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
