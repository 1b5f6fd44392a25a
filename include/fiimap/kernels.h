#pragma once

#include <cstdint>
#include <vector>

#include "fiimap/bit_column.h"
#include "fiimap/log_odds.h"
#include "fiimap/vector_room.h"

namespace fiimap {

/// A ray's way over the columns of a box, in slabs: between two borders of its major axis, along
/// which it advances faster, it crosses at most one border of its minor axis.
/// Lengths are voxel edges; t is the place on the ray, in any unit, 0 at its origin.
struct ColumnLine {
  int slabs;              ///< columns along the major axis, >= 1
  float start_t;          ///< where the ray enters the box
  float end_t;            ///< where it ends
  float first_border;     ///< distance along the major axis from the origin to the border behind it
  float major_step;       ///< +1 or -1
  float t_per_major;      ///< t per distance along the major axis; 0 when there is one slab
  float minor_origin;     ///< of the ray, in the box
  float minor_direction;  ///< along the minor axis per t
  float minor_border;     ///< from a cell's low border to the one that the ray leaves by, from
                          ///< the origin: 0 or 1, less minor_origin
  float t_per_minor;      ///< t per distance along the minor axis
  int last_minor_cell;    ///< of the box
  int first_column;       ///< offset of the first slab's column of minor cell 0
  int major_offset;       ///< to the next slab's
  int minor_offset;       ///< to the next minor cell's
  int minor_step;         ///< +1 or -1
};

/// The columns that a ray crosses, nearest first. It is in column k from t[k] to t[k + 1].
struct ColumnWalk {
  std::vector<std::int32_t> column;         ///< offset of its lowest word
  std::vector<float> t;                     ///< one more than columns
  std::vector<std::int32_t> first_of_slab;  ///< index in `column`
  int size = 0;                             ///< columns

  /// Makes room for what a kernel may write.
  void reserve(int slabs);
};

/// Runs of neighbouring rays, and a part of the columns that they cross together: in each column a
/// run touches the voxels from where its lowest ray is lowest to where its highest is highest.
struct RayRuns {
  const std::int32_t* column;  ///< offset of its lowest word
  const float* t;              ///< rays are in column k from t[k] to t[k + 1]
  int columns;                 ///< of this part
  float origin_z;              ///< of the rays, voxel edges
  ///@{
  /// Of each run's lowest and highest ray: voxel edges per t.
  const float *rise_low, *rise_high;
  ///@}
  int runs;  ///< how many
};

/// Samples of one row of a depth image, and the parts of their rays at unit depth (world axes): the
/// ray of sample i is (ray_x[i] + row_x, ...), the square of its length length_2[i] + row_length_2.
struct DepthRow {
  const float* depth;  ///< metres; NaN where no distance was measured
  int samples;         ///< in the row
  ///@{
  /// Part of a ray's coordinate, or of its squared length.
  const float *ray_x, *ray_y, *ray_z, *length_2;
  float row_x, row_y, row_z, row_length_2;
  ///@}
  ///@{
  /// Of returns: metres, square metres.
  float min_depth, max_depth, min_length_2, max_length_2;
  ///@}
};

/// What a row of samples was split into.
struct RowCount {
  int returns = 0;  ///< written
  int others = 0;   ///< listed
};

/// Points relative to the rays' origin, metres, finite also in voxel edges, and the box in which
/// their rays end. The origin lies in the box.
struct EndPoints {
  ///@{
  /// Coordinates, metres.
  const float *x, *y, *z;
  ///@}
  int count;             ///< points
  float to_voxels;       ///< voxel edges per metre
  float origin[3];       ///< voxel edges, in the box
  std::int32_t size[3];  ///< of the box, voxels
};

/// Voxels of the box where rays end. Rays that leave the box end in the last voxel of it that they
/// cross; they have kLeavesBox in `z`. Those that never enter it end nowhere: `z` is kMissesBox.
struct RayEnds {
  static constexpr std::int32_t kLeavesBox = 1 << 24;         ///< more than any height
  static constexpr std::int32_t kMissesBox = 2 * kLeavesBox;  ///< likewise
  ///@{
  /// Coordinates in the box, voxels.
  std::vector<std::int32_t> x, y, z;
  ///@}
  /// The points first[k] to first[k + 1] - 1 end in voxel k.
  std::vector<std::int32_t> first;
  int size = 0;  ///< voxels
  ///@{
  /// Smallest and largest x and y of all that end somewhere; of none, the first is the larger.
  std::int32_t low[2], high[2];
  ///@}

  /// Begins an empty list, with room for what a kernel may write.
  void begin(int count);
};

/// A bit for each voxel of a box: x-major columns of words, bit 0 of the first is the lowest voxel.
struct VoxelBits {
  const std::uint64_t* words;     ///< of all columns
  std::int32_t size_y;            ///< columns of the same x
  std::int32_t words_per_column;  ///< >= 1
};

/// A cube around the origin of rays, with a grid of cells of a voxel edge on each side face: cells
/// 0 to side() - 1 along either axis. That in the middle, on the axis, is half_side; the outermost
/// stand out by half a cell.
struct DirectionCube {
  /// Rays that end less than this inside of the cube are straight, so that a rounded one ends in
  /// the column of the straight one, whatever is rounded. Voxel edges.
  static constexpr float kSlack = 0.25f;
  int half_side;                                  ///< voxel edges
  float origin[3];                                ///< voxel edges from the corner of the box
  int side() const { return 2 * half_side + 1; }  ///< cells
};

/// Rays to the centres of some voxels, as the cube sees them.
struct CubeRays {
  static constexpr std::int32_t kStraight = -1;  ///< in `slice`
  /// Column of cells that the ray crosses, of all faces side by side, side() each; kStraight when
  /// it crosses none.
  std::vector<std::int32_t> slice;
  std::vector<std::int32_t> cell;  ///< of the column
  /// Distance that the ray goes along the axis of the face, voxel edges; of straight rays,
  /// anything.
  std::vector<float> reach;

  /// Makes room for what a kernel may write.
  void reserve(int count);
};

/// A word of each column of a tile at one x, side by side along y. Aligned, so that no vector
/// crosses a border of cache lines.
struct alignas(64) Strip {
  static constexpr int kColumns = 32;  ///< of a tile at one x
  static constexpr int kGroup = 8;     ///< columns of the longest vector
  std::uint64_t words[kColumns];       ///< by y in the tile
};

/// Columns first..end-1 of a strip. Kernels may write the others, too.
struct StripSpan {
  ///@{
  /// Columns, 0 to Strip::kColumns.
  int first, end;
  ///@}
};

/// From the first set bit to the last one; there must be one.
inline StripSpan spanOf(std::uint32_t columns) {
  return {__builtin_ctz(columns), Strip::kColumns - __builtin_clz(columns)};
}

/// Dilation of columns by a structuring element, as Horner's scheme along z: to nothing, add the
/// sources of the largest half height, dilate by one voxel up and down, add those of the next
/// smaller half height, and so on down to 0.
struct ColumnDilation {
  int words;      ///< of a column
  int word_step;  ///< from a word of the sources to the next one, strips
  int row_step;   ///< from the sources of a row to those of the next one, strips
  ///@{
  /// Ring masks: all voxels but the window's top or bottom, whose bits leave it.
  std::vector<std::uint64_t> not_top, not_bottom;
  ///@}
  std::vector<std::int32_t> sources;  ///< strips to add, counted from that of the row itself
  std::vector<int> sources_end;       ///< of each half height, the largest first
};

/// The inner loops of the map, once for each instruction set that the machine may have. All give
/// the same bits: they compute the same single-precision expressions, without contraction.
struct Kernels {
  const char* name;  ///< as FIIMAP_SIMD names them

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

  /// Lists the k in [first, last) for which the bit of the voxel ends[k] has a value. The bits of
  /// ends of rays that leave the box count as 0. `listed` has room for kVectorRoom more.
  /// \return how many.
  int (*selectEnds)(const RayEnds& ends, int first, int last, const VoxelBits& bits, bool value,
                    std::int32_t* listed);

  /// Finds the cells through which the rays to the voxels ends[index[i]], i < count, run. They end
  /// `cut` voxel edges before the voxel's centre; those that are shorter have a reach below 0.
  void (*roundRays)(const DirectionCube& cube, const RayEnds& ends, const std::int32_t* index,
                    int count, float cut, CubeRays* rays);

  /// Amanatides & Woo's walk without decisions from step to step.
  void (*walk)(const ColumnLine& line, ColumnWalk* walk);

  /// Sets the voxels that runs of rays touch, clipped to heights 0..height-1.
  void (*freeRuns)(const RayRuns& part, int height, std::uint64_t* free);

  /// One observation for each voxel in hit[w] or free[w] (disjoint) of `words` words: log-odds are
  /// added and clamped (eq. 6-8). Voxels that are not in known[w] start at 0, whatever their byte
  /// holds. log_odds has 64 bytes per word; occupied[w] is updated.
  void (*observe)(const LogOdds& l, int words, const std::uint64_t* hit, const std::uint64_t* free,
                  const std::uint64_t* known, std::uint64_t* occupied, std::int8_t* log_odds);

  /// Unions of neighbours in `rows` rows that are `row_step` words apart: column c of widened[k]
  /// gets row[c - k] | ... | row[c + k], for k = 0..reach; the next row's strips follow. May read
  /// all of the columns -reach to Strip::kColumns + reach - 1 of a row.
  void (*widen)(const std::uint64_t* row, int row_step, int rows, StripSpan span, int reach,
                Strip* widened);

  /// Dilates columns of `rows` rows.
  /// \param source the first row's strip.
  /// \param columns bits of the columns of each row that are wanted; those between are dilated,
  /// too. \param dilated one strip per word for each row.
  void (*dilate)(const ColumnDilation& dilation, const Strip* source, const std::uint32_t* columns,
                 int rows, Strip* dilated);

  /// Replaces words.
  /// \return how many bits more are set than before.
  int (*replace)(const std::uint64_t* words, int count, std::uint64_t* target);

  /// Replaces columns of one word in `rows` rows of a tile.
  /// \param words one strip for each row.
  /// \param columns bits of the columns of each row; those between are replaced, too.
  /// \param target the first column of the first row.
  /// \return how many bits more are set than before.
  int (*replaceRows)(const Strip* words, const std::uint32_t* columns, int rows,
                     std::uint64_t* target);

  /// Adds the bits of words to those of the target, `count` (a multiple of Strip::kGroup) in each
  /// of `rows` rows that are row_step and target_step words apart. \return how many bits more are
  /// set than before.
  int (*add)(const std::uint64_t* words, int row_step, int rows, int count, std::uint64_t* target,
             int target_step);
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
