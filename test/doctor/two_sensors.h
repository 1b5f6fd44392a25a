#pragma once

#include <functional>
#include <string>

#include "seen_vehicle.h"

namespace fiimap {

/// Adds the scans of another vehicle, as if they were of this one.
void addScans(const Observation& other, Observation* seen);

/// A camera ahead, and one of another name and frame that looks to the left.
struct TwoCameras {
  SeenVehicle vehicle, left;
  std::function<void(Observation*)> more = [](Observation*) {};  ///< set after the messages

  TwoCameras();

  template <typename Message>
  static std::function<bool(Message*)> setFrame(const std::string& frame) {
    return [frame](Message* message) {
      message->header.frame_id = frame;
      return kComes;
    };
  }

  Diagnosis diagnosis(const DoctorWishes& wishes = {});
};

/// A camera ahead and a LiDAR on top.
SeenVehicle withCameraAndLidar();

}  // namespace fiimap
