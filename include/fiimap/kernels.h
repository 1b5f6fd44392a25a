#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/bit_column.h"
#include "fiimap/log_odds.h"
#include "fiimap/vector_room.h"

namespace fiimap {

/// A ray's way over the columns of a box, in slabs: between two borders of its major axis, along
/// which it advances faster, it crosses at most one border of its minor axis.
/// Lengths are voxel edges; t is 0 at the ray's origin and 1 at its end.
struct ColumnLine {
  int slabs;              ///< columns along the major axis, >= 1
  float start_t;          ///< where the ray enters the box
  float first_border;     ///< distance along the major axis from the origin to the border behind it
  float major_step;       ///< +1 or -1
  float t_per_major;      ///< t per distance along the major axis; 0 when there is one slab
  float minor_origin;     ///< of the ray, in the box
  float minor_direction;  ///< from origin to end
  float minor_border;     ///< from a cell's low border to the one that the ray leaves by, from
                          ///< the origin: 0 or 1, less minor_origin
  float t_per_minor;
  int last_minor_cell;  ///< of the box
  int first_column;     ///< offset of the first slab's column of minor cell 0
  int major_offset;     ///< to the next slab's
  int minor_offset;     ///< to the next minor cell's
  int minor_step;       ///< +1 or -1
};

/// The columns that a ray crosses, nearest first. It is in column k from t[k] to t[k + 1].
struct ColumnWalk {
  std::vector<std::int32_t> column;  ///< offset of its lowest word
  std::vector<float> t;
  int size = 0;

  /// Makes room for what a kernel may write.
  void reserve(int slabs);
};

/// Neighbouring rays to one end column, and the part of its walk that they go together: in each
/// column they touch the voxels from origin_z + rise_low t to origin_z + rise_high t.
struct FanPart {
  const std::int32_t* column;  ///< offset of its lowest word
  const float* t_low;          ///< per column, where the lowest ray is lowest
  const float* t_high;         ///< per column, where the highest ray is highest
  int columns;
  float origin_z, rise_low, rise_high;  ///< voxel edges
  float lowest, highest;                ///< bounds of what all columns touch
};

/// Samples of one row of a depth image, and the parts of their rays at unit depth (world axes): the
/// ray of sample i is (ray_x[i] + row_x, ...), the square of its length length_2[i] + row_length_2.
struct DepthRow {
  const float* depth;  ///< metres; NaN where no distance was measured
  int samples;
  const float *ray_x, *ray_y, *ray_z, *length_2;
  float row_x, row_y, row_z, row_length_2;
  float min_depth, max_depth, min_length_2, max_length_2;  ///< of returns
};

/// What a row of samples was split into.
struct RowCount {
  int returns = 0;
  int others = 0;  ///< listed
};

/// Points relative to the rays' origin, metres, and the box in which their rays end: whose columns,
/// x-major, have `words` 64-bit words each. The origin lies in the box.
struct EndPoints {
  const float *x, *y, *z;
  int count;
  float to_voxels;
  float origin[3];  ///< voxel edges, in the box
  std::int32_t size[3];
  int words;
};

/// Voxels where rays end. Rays that leave the box end in the last voxel of it that they cross; they
/// have kLeavesBox in `z`. Those that never enter it end nowhere: `z` is kMissesBox.
struct RayEnds {
  static constexpr std::int32_t kLeavesBox = 1 << 24;  ///< more than any height
  static constexpr std::int32_t kMissesBox = 2 * kLeavesBox;
  std::vector<std::int32_t> column;                    ///< offset of its lowest word
  std::vector<std::int32_t> z;
  /// The points first[k] to first[k + 1] - 1 end in voxel k.
  std::vector<std::int32_t> first;
  int size = 0;

  /// Makes room for what a kernel may write.
  void reserve(int count);
};

/// The inner loops of the map, once for each instruction set that the machine may have. All give
/// the same bits: they compute the same single-precision expressions, without contraction.
struct Kernels {
  const char* name;

  /// Depth in metres of every `step`-th 16-bit pixel (need not be aligned); NaN for 0 and 65535.
  void (*readDepths)(const std::uint8_t* pixels, int step, int samples, float scale, float* depth);

  /// Back-projects a row (eq. 3): writes the returns to x, y, z, which have room for all samples
  /// and kVectorRoom more; lists the samples that are no return, but for those without a distance
  /// unless `list_invalid`.
  RowCount (*projectRow)(const DepthRow& row, bool list_invalid, float* x, float* y, float* z,
                         std::int32_t* others);

  /// Lists where rays end, in order. An end that is that of the ray before it may be left out: most
  /// are, because neighbouring pixels see neighbouring points.
  void (*listEnds)(const EndPoints& points, RayEnds* ends);

  /// Amanatides & Woo's walk without decisions from step to step.
  void (*walk)(const ColumnLine& line, ColumnWalk* walk);

  /// Sets the voxels of a fan, clipped to heights 0..height-1.
  void (*freeFan)(const FanPart& fan, int height, std::uint64_t* free);

  /// One observation for each voxel in hit[w] or free[w] (disjoint) of `words` words: log-odds are
  /// added and clamped (eq. 6-8). Voxels that are not in known[w] start at 0, whatever their byte
  /// holds. log_odds has 64 bytes per word; occupied[w] is updated.
  void (*observe)(const LogOdds& l, int words, const std::uint64_t* hit, const std::uint64_t* free,
                  const std::uint64_t* known, std::uint64_t* occupied, std::int8_t* log_odds);
};

/// In plain C++, which the compiler turns into the instructions that every machine has.
const Kernels& plainKernels();

/// All that this machine can run, the best first; the last are the plain ones.
std::vector<const Kernels*> availableKernels();

/// Those to use: the best, or those that the environment variable FIIMAP_SIMD names (for tests and
/// measurements). Thread-safe.
/// \throws std::runtime_error when the machine has none of that name.
const Kernels& kernels();

}  // namespace fiimap
