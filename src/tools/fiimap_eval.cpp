#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "run_command.h"

int main(int argc, char** argv) {
  CLI::App app("Offline evaluation of fiimap on recorded data");
  app.require_subcommand(1);

  fiimap::RunOptions options;
  CLI::App* run = app.add_subcommand(
      "run", "Builds the map of a bag as the nodelet would and prints what it cost");
  run->add_option("bag", options.bag, "Recording (ROS 1 bag)")
      ->required()
      ->check(CLI::ExistingFile);
  run->add_option("--config", options.config, "Parameters (YAML, as for the nodelet)")
      ->check(CLI::ExistingFile);
  run->add_option("--set", options.settings, "name=value, overrides the file; may be repeated");
  run->add_option("--json", options.json, "Write the figures to this file");
  run->add_option("--save", options.save,
                  "Write the final map to PREFIX_occupied.pcd, PREFIX_inflated.pcd and PREFIX.bt");
  run->add_option("--verify", options.verify,
                  "Compare the inflated layer with brute force at every N-th scan")
      ->check(CLI::PositiveNumber);

  CLI::App* parameters = app.add_subcommand("parameters", "Lists every parameter");
  CLI11_PARSE(app, argc, argv);

  try {
    if (parameters->parsed()) {
      fiimap::printParameters();
      return 0;
    }
    return fiimap::run(options);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
