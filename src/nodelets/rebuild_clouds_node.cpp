// Stand-alone node around fiimap/RebuildCloudsNodelet.

#include <csignal>
#include <string>
#include <vector>

#include <nodelet/loader.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "rebuild_clouds");
  // ROS ends cleanly on Ctrl-C alone; containers and service managers send this.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  const ros::NodeHandle keep_ros_running;
  const bool provide_services = false;
  nodelet::Loader loader(provide_services);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool loaded = loader.load(ros::this_node::getName(), "fiimap/RebuildCloudsNodelet",
                                  ros::names::getRemappings(), arguments);
  if (!loaded) {
    ROS_FATAL("The nodelet could not be loaded; see the messages above.");
    return 1;
  }
  ros::spin();
  return 0;
}
