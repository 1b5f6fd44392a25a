#pragma once

#include <string>
#include <vector>

#include "fiimap/mapper.h"
#include "fiimap/ros/message_conversions.h"

namespace fiimap::bench {

/// A depth image in memory with all that is needed to integrate it.
struct Frame {
  DecodedDepthImage image;
  PinholeIntrinsics intrinsics;
  ScanPose pose;
};

/// Frames of a bag under the name that tables show.
struct Recording {
  std::string name;
  std::vector<Frame> frames;
};

/// Reads the first frames of a bag, synchronised as the node does it with its defaults.
/// \throws std::exception when the bag cannot be read or holds no depth image with a pose.
Recording loadRecording(const std::string& name, const std::string& bag, std::size_t max_frames);

/// Reads NAME=BAG.
/// \throws std::invalid_argument when there is no name or no path.
Recording loadRecording(const std::string& name_and_bag, std::size_t max_frames);

}  // namespace fiimap::bench
