#pragma once

#include <cstdint>
#include <vector>

#include "depth_camera.h"

namespace fiimap::sim {

/// Errors of a stereo camera with a structured-light projector; names are the parameter names. The
/// defaults are those of an Intel RealSense D435 at 640 x 480.
struct NoiseConfig {
  bool depth_noise = false;
  double baseline = 0.05;
  double disparity_step = 0.03125;
  double disparity_noise = 0.08;
  double dropout = 0.002;
  double max_incidence = 1.4;
};

/// Spoils exact depth as stereo matching does. Depth is focal length x baseline / disparity, so
/// that noise and steps of the disparity grow with the square of the distance. Missing are: what
/// only one of the two cameras sees (to the left of near edges), surfaces seen at a flat angle, and
/// a few pixels anywhere. Missing depth is infinite.
class DepthNoise {
 public:
  DepthNoise(const NoiseConfig& config, double focal_length, std::uint64_t seed);

  /// The same frame with the same number gets the same errors, whatever came before.
  /// \param number of the frame; \param frame with its cosines of incidence.
  void apply(std::uint64_t number, DepthFrame* frame) const;

 private:
  void hideShadows(const float* row, int width, std::vector<bool>* hidden) const;

  NoiseConfig config_;
  float depth_times_disparity_;  // m pixels
  float min_cos_incidence_;
  std::uint64_t seed_;
};

/// Depth as a camera delivers it: millimetres, 0 where it is out of range or missing.
std::vector<std::uint16_t> toMillimetres(const DepthFrame& frame, double min_range,
                                         double max_range);

}  // namespace fiimap::sim
