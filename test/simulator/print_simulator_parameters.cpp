// Prints the simulator's parameters as `fiimap_eval parameters` does, for check_parameter_docs.py.

#include <iostream>

#include "simulator_config.h"

int main() {
  fiimap::sim::SimulatorConfig config;
  for (const fiimap::Parameter& p : fiimap::sim::simulatorParameters(&config)) {
    std::cout << p.name << '\t' << p.get() << '\t' << p.unit << '\t' << p.allowed << '\t'
              << p.meaning << '\n';
  }
  return 0;
}
