#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "recorded_trajectory.h"

namespace fiimap {

/// How to render a recorded way of the camera as a bag in the form of the Cow_and_Lady recording.
struct RoomRecordingOptions {
  int pixel_step = 2;  ///< keep every n-th pixel of every n-th row, 1 to 16
  std::uint64_t seed = 1;
  std::string compression = "lz4";  ///< lz4, bz2 or none
};

/// What was rendered.
struct RoomRecordingFigures {
  std::size_t scans = 0;
  double duration = 0.0;         ///< from the first stamp to the last, s
  double least_clearance = 0.0;  ///< of the camera from any surface, m
  double invalid_share = 0.0;    ///< of the pixels
};

/// Renders a cloud for each scan, recorded as late as the real one was, and the transform of the
/// marker body 100 times a second. The file appears under its name when it is complete.
/// \param progress is told how many scans are done.
/// \throws std::invalid_argument when an option is bad, std::exception when writing fails.
RoomRecordingFigures writeRoomRecording(const std::vector<RecordedScan>& scans,
                                        const RoomRecordingOptions& options,
                                        const std::string& file,
                                        const std::function<void(std::size_t)>& progress);

}  // namespace fiimap
