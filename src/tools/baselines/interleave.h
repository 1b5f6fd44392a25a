#pragma once

#include <algorithm>
#include <cstddef>

namespace fiimap::bench {

/// Methods take turns every so many frames: often enough that noise of the machine hits all of them
/// alike, seldom enough that each finds its own data in the caches as it would on a vehicle.
constexpr std::size_t kBlockFrames = 10;

/// Calls run(method, frame) for every frame and method: each method takes the frames in order, a
/// block at a time; in every block another method begins.
template <typename Run>
void interleave(std::size_t methods, std::size_t frames, Run&& run) {
  for (std::size_t block = 0; block * kBlockFrames < frames; ++block) {
    const std::size_t end = std::min(frames, (block + 1) * kBlockFrames);
    for (std::size_t turn = 0; turn < methods; ++turn) {
      const std::size_t method = (turn + block) % methods;
      for (std::size_t frame = block * kBlockFrames; frame < end; ++frame) run(method, frame);
    }
  }
}

}  // namespace fiimap::bench
