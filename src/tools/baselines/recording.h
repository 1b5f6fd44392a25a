#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fiimap/mapper.h"
#include "fiimap/ros/message_conversions.h"
#include "fiimap/ros/scan_synchronizer.h"

namespace fiimap::bench {

/// A scan in memory, decoded, with all that is needed to integrate it.
struct Frame {
  DecodedDepthImage image;
  PinholeIntrinsics intrinsics;  ///< of the image
  ScanPose pose;
  std::optional<PointScan> points;  ///< a cloud instead of an image
};

/// \param pixel_step of organised clouds. \throws InputError when the message cannot be used.
Frame frameOf(const SynchronizedScan& scan, int pixel_step);

/// \throws std::invalid_argument when the mapper refuses the frame.
ScanReport integrate(const Frame& frame, Mapper* mapper);

/// Frames of a bag under the name that tables show.
struct Recording {
  std::string name;
  std::vector<Frame> frames;
};

/// Reads the first depth images of a bag, synchronised as the node does it with its defaults.
/// \throws std::exception when the bag cannot be read or holds no depth image with a pose.
Recording loadRecording(const std::string& name, const std::string& bag, std::size_t max_frames);

/// Reads NAME=BAG.
/// \throws std::invalid_argument when there is no name or no path.
Recording loadRecording(const std::string& name_and_bag, std::size_t max_frames);

}  // namespace fiimap::bench
