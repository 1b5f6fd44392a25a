#pragma once

#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace fiimap {

/// What the points of the clouds of a topic are.
struct CloudFigures {
  struct Sample {
    ros::Time stamp;
    std::vector<Eigen::Vector3f> points;  ///< finite, in the frame of the cloud, m
  };

  std::size_t clouds = 0;      ///< that can be read
  std::size_t points = 0;      ///< looked at: some of each cloud
  std::size_t finite = 0;      ///< of them; without those at the origin, which mean no return
  std::vector<double> ranges;  ///< of the finite ones from the origin of the cloud's frame, m
  Sample first, last;          ///< all points of these clouds
  bool is_organised = false;   ///< rows and columns, as from a camera
  std::string unreadable;      ///< why the newest cloud that could not be read cannot be used

  void add(const sensor_msgs::PointCloud2& cloud);

  double finiteShare() const;
};

}  // namespace fiimap
