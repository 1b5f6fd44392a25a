#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "fiimap/kernels.h"
#include "fiimap/mapper_config.h"
#include "fiimap/range_data.h"

namespace fiimap {

/// Pinhole camera without distortion, pixels.
struct PinholeIntrinsics {
  ///@{
  /// Focal length and principal point along the image's x and y.
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
  ///@}

  /// Finite, with positive focal lengths.
  bool valid() const;
};

/// View of a depth image in native byte order; does not own its pixels.
struct DepthImage {
  /// What a pixel is.
  enum class Format {
    kUint16,   ///< units of depth_scale (REP 118: millimetres); 0 and 65535 are invalid
    kFloat32,  ///< metres; NaN and values <= 0 are invalid, +inf is "farther than the sensor sees"
  };

  const void* data = nullptr;       ///< first pixel of the first row; need not be aligned
  Format format = Format::kUint16;  ///< of all pixels
  int width = 0;                    ///< pixels
  int height = 0;                   ///< pixels
  std::size_t row_bytes = 0;        ///< distance between rows, >= width * bytes per pixel
};

/// Back-projects depth images (eq. 3) on a grid of pixels (eq. 4-5).
/// Not thread-safe (keeps scratch memory).
class DepthProjector {
 public:
  /// \param config validated.
  explicit DepthProjector(const MapperConfig& config);

  /// Fills `scan` anew with the image's rays.
  /// \param T_W_C camera (optical frame: z forward, x right, y down) to world.
  ReadingCount project(const DepthImage& image, const PinholeIntrinsics& intrinsics,
                       const Eigen::Isometry3d& T_W_C, RangeData* scan);

  /// Step along u (x) and v (y): pixel_step, or for 0 the paper's eq. 5, (f / d_max) r, at least 1.
  Eigen::Vector2i pixelStep(const PinholeIntrinsics& intrinsics) const;

 private:
  /// Rays at unit depth, one array per world axis, and the square of their length.
  struct RayParts {
    int size = 0;
    std::vector<float> x, y, z, length_2;  // with room for a vector more
    void resize(int new_size);
    void set(int i, const Eigen::Vector3d& ray, double length_2_part);
  };
  /// In single precision.
  struct Limits {
    float min_depth, max_depth, min_length, max_length;
    float end_cut;  // metres
  };

  ReadingCount projectRows(const DepthImage& image, const Eigen::Vector2i& step, RangeData* scan);
  void readDepths(const DepthImage& image, int v, int step);
  void addOther(float depth, const Eigen::Vector3f& ray, RangeData* scan,
                ReadingCount* count) const;

  MapperConfig config_;
  Limits limits_;
  const Kernels& kernels_;
  // The ray of pixel (u, v) is the sum of a part of u and one of v; by number of the sample.
  RayParts ray_of_u_, ray_of_v_;
  std::vector<float> depths_;         // of a row
  std::vector<std::int32_t> others_;  // samples of a row that are no returns
};

}  // namespace fiimap
