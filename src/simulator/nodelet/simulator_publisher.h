#pragma once

#include <cstdint>
#include <vector>

#include <ros/ros.h>

#include "simulator.h"

namespace fiimap::sim {

/// The topics of the simulator. Used by the simulating thread, except timeOf().
class SimulatorPublisher {
 public:
  /// Time zero is now; where time is simulated, an arbitrary moment.
  /// \param node of the vehicle's topics; \param private_node of the truth.
  SimulatorPublisher(ros::NodeHandle node, ros::NodeHandle private_node,
                     const SimulatorConfig& config, const World& world);

  /// Simulated time, s, of a stamp. Thread-safe.
  double timeOf(const ros::Time& stamp) const;

  /// What is due of clock, odometry, TF, truth and markers.
  void publishState(Simulator& simulator);

  bool imageIsWanted() const {
    return image_publisher_.getNumSubscribers() + camera_info_publisher_.getNumSubscribers() > 0;
  }
  void publishImage(double time, const std::vector<std::uint16_t>& millimetres);
  bool cloudIsWanted() const { return cloud_publisher_.getNumSubscribers() > 0; }
  void publishCloud(double time, const std::vector<Eigen::Vector3f>& points);

 private:
  std_msgs::Header headerAt(double time, const std::string& frame) const;
  void publishStatic(const World& world);
  void publishOdometry(const OdometrySample& sample);
  void publishTruth(const Simulator& simulator);

  SimulatorConfig config_;
  ros::Time start_;
  ros::Publisher clock_publisher_;
  ros::Publisher odometry_publisher_;
  ros::Publisher transform_publisher_;
  ros::Publisher static_transform_publisher_;
  ros::Publisher image_publisher_;
  ros::Publisher camera_info_publisher_;
  ros::Publisher cloud_publisher_;
  ros::Publisher truth_publisher_;
  ros::Publisher world_publisher_;
  ros::Publisher moving_publisher_;
};

}  // namespace fiimap::sim
