#include <boost/program_options.hpp>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "run_command.h"

namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "Offline evaluation of fiimap on recorded data\n\n"
    "  fiimap_eval run BAG [options]   builds the map of a bag as the nodelet would, and prints "
    "what "
    "it cost\n"
    "  fiimap_eval parameters          lists the parameters of map and node: name, default, unit, "
    "allowed values, meaning\n\n"
    "Topics that are not found by type are set like parameters: depth_topic, camera_info_topic, "
    "points_topic, pose_topic.\n\n";

struct CommandLine {
  std::string command;
  fiimap::RunOptions run;
};

po::options_description describeOptions(fiimap::RunOptions* run) {
  po::options_description options("Options of run");
  options.add_options()("help,h", "this text")("config",
                                               po::value(&run->config)->value_name("FILE"),
                                               "parameters (YAML, as for the nodelet)")(
      "set", po::value(&run->settings)->value_name("NAME=VALUE")->composing(),
      "a parameter, after those of the file; may be repeated")(
      "json", po::value(&run->json)->value_name("FILE"), "write the figures to this file")(
      "save", po::value(&run->save)->value_name("PREFIX"),
      "write the final map to PREFIX_occupied.pcd, PREFIX_inflated.pcd and PREFIX.bt")(
      "verify", po::value(&run->verify)->value_name("N"),
      "compare the inflated layer with brute force at every N-th scan and at the last");
  return options;
}

/// \return an empty command when help was asked for.
CommandLine parse(int argc, char** argv) {
  CommandLine line;
  const po::options_description visible = describeOptions(&line.run);
  po::options_description all;
  all.add(visible).add_options()("command", po::value(&line.command))("bag",
                                                                      po::value(&line.run.bag));
  po::positional_options_description positions;
  positions.add("command", 1).add("bag", 1);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional(positions).run(), values);
  po::notify(values);

  if (values.count("help") > 0) {
    std::cout << kUsage << visible;
    line.command.clear();
    return line;
  }
  if (line.command != "run" && line.command != "parameters") {
    throw std::invalid_argument("the command must be run or parameters; see fiimap_eval --help");
  }
  if (line.command == "run" && line.run.bag.empty()) {
    throw std::invalid_argument("run needs a bag; see fiimap_eval --help");
  }
  if (values.count("verify") > 0 && line.run.verify < 1) {
    throw std::invalid_argument("--verify must be at least 1");
  }
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const CommandLine line = parse(argc, argv);
    if (line.command == "run") return fiimap::run(line.run);
    if (line.command == "parameters") fiimap::printParameters();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
