#pragma once

namespace fiimap {

/// Kernels may read and write whole vectors: this many numbers beyond those that count. No vector
/// is longer.
constexpr int kVectorRoom = 64;

}  // namespace fiimap
