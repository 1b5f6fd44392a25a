#include "element_stamp.h"

#include <algorithm>

namespace fiimap {

ElementStamp::ElementStamp(const StructuringElement& element) : reach_(element.reach()) {
  for (int dx = -reach_; dx <= reach_; ++dx) {
    for (int dy = -reach_; dy <= reach_; ++dy) {
      const int position = (dx + reach_) * step() + kMargin + dy + reach_;
      const int half_height = element.halfHeight(dx, dy);
      if (half_height >= 0) columns_.push_back({position, half_height});
    }
  }
}

bool ElementStamp::fits(const VoxelIndex& v, const VoxelBox& window) const {
  return v.x() - reach_ >= window.min.x() && v.x() + reach_ < window.max.x() &&
         v.y() - reach_ >= window.min.y() && v.y() + reach_ < window.max.y();
}

/// Tile by tile, mostly one or two; a tile's side is whole groups.
void ElementStamp::apply(const VoxelIndex& v, SlidingGrid* grid) {
  print(v, *grid);
  const int words = grid->layout().words();
  const int low_x = v.x() - reach_, low_y = v.y() - reach_;
  const int end_x = v.x() + reach_ + 1;
  const int end_y = (v.y() + reach_ + Strip::kGroup) & -Strip::kGroup;
  for (int x = low_x, next_x; x < end_x; x = next_x) {
    next_x = std::min(end_x, tileFloor(x) + kTileSide);
    for (int y = low_y & -Strip::kGroup, next_y; y < end_y; y = next_y) {
      next_y = std::min(end_y, tileFloor(y) + kTileSide);
      const int first = (x - low_x) * step() + kMargin + y - low_y;
      grid->addToColumns(Plane::kInflated, x, y, next_x - x, next_y - y,
                         print_.data() + first * words, step() * words);
    }
  }
}

/// Lays out the columns around the voxel; between them nothing is ever written.
void ElementStamp::print(const VoxelIndex& v, const SlidingGrid& grid) {
  const int words = grid.layout().words();
  heights_.resize(static_cast<std::size_t>(words) * (reach_ + 1));
  print_.resize(static_cast<std::size_t>(words) * (2 * reach_ + 1) * step());
  for (int h = 0; h <= reach_; ++h) {
    grid.heightMask(v.z() - h, v.z() + h + 1, heights_.data() + h * words);
  }
  if (words == 1) {  // which the compiler then knows: less than half of the instructions
    for (const Column& c : columns_) print_[c.position] = heights_[c.half_height];
    return;
  }
  for (const Column& c : columns_) {
    std::copy_n(&heights_[c.half_height * words], words, &print_[c.position * words]);
  }
}

}  // namespace fiimap
