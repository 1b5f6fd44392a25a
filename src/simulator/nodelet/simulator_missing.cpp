#include <stdexcept>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

namespace fiimap::sim {

/// In the place of the simulator where the package was built without it: says why.
class SimulatorNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    const char* const reason =
        "the simulator was left out of this build: install libembree-dev (3.8 to 3.13) and "
        "libassimp-dev and build again";
    NODELET_FATAL("%s", reason);
    throw std::runtime_error(reason);
  }
};

}  // namespace fiimap::sim

PLUGINLIB_EXPORT_CLASS(fiimap::sim::SimulatorNodelet, nodelet::Nodelet)
