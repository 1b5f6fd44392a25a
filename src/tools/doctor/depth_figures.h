#pragma once

#include <sensor_msgs/Image.h>

#include <cstddef>
#include <string>
#include <vector>

#include "quantiles.h"

namespace fiimap {

/// What the pixels of the depth images of a topic are, counted on a coarse grid of each image.
struct DepthFigures {
  std::size_t pixels = 0;          ///< looked at
  std::size_t zero = 0;            ///< or less
  std::size_t not_a_number = 0;    ///< NaN or -infinity
  std::size_t infinite = 0;        ///< +infinity
  std::size_t saturated = 0;       ///< 65535 of 16 bits
  std::vector<double> readings{};  ///< the others, in the unit of the image
  bool is_16bit = false;
  std::string unreadable;  ///< why the newest image that could not be read cannot be used

  void add(const sensor_msgs::ImageConstPtr& image);

  /// Share of the pixels that are readings.
  double readingShare() const;
};

}  // namespace fiimap
