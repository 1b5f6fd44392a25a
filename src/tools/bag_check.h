#pragma once

#include <rosbag/bag.h>

#include <string>

namespace fiimap {

/// Whether a bag's records fit into each other: rosbag trusts every length and position in the
/// file, and where one lies, it reads beyond its memory or asks for gigabytes. Looks at all records
/// that are not compressed; what is compressed has checksums, which rosbag compares. Files that are
/// no bags of format 2.0 are left to rosbag. \throws std::invalid_argument that tells where the
/// file is damaged, or that it cannot be read.
void requireSoundBag(const std::string& file);

/// Opens a bag to read, if it is sound.
/// \throws std::invalid_argument that tells why it cannot be read.
void openBag(const std::string& file, rosbag::Bag* bag);

}  // namespace fiimap
