#pragma once

#include <cstdint>

namespace fiimap::sim {

/// Small generator of random numbers. Unlike the distributions of the standard library it gives the
/// same numbers with every compiler, so that a seed means the same world everywhere.
class Random {
 public:
  /// Numbers of different streams of a seed are independent.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix(seed) ^ mix(mix(stream) + kIncrement)) {}

  /// 64 random bits (SplitMix64: Steele, Lea, Flood 2014).
  std::uint64_t bits() { return mix(state_ += kIncrement); }

  /// In [low, high).
  double uniform(double low, double high) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * (static_cast<double>(bits() >> 11) * kUnit);
  }

  /// \param low, high both included.
  int uniformInt(int low, int high) {
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }

  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

  /// Mean 0, standard deviation 1: the sum of four uniform numbers of 16 bits, which never exceeds
  /// 3.47. Nearly normal, and a hundred million a second.
  float normal() {
    constexpr float kMean = 2.0f * 65535.0f;
    constexpr float kInverseDeviation = 1.0f / 37837.22f;  // sqrt(4 (65536^2 - 1) / 12)
    const std::uint64_t r = bits();
    const auto sum =
        static_cast<float>((r & 0xffff) + (r >> 16 & 0xffff) + (r >> 32 & 0xffff) + (r >> 48));
    return (sum - kMean) * kInverseDeviation;
  }

 private:
  static constexpr std::uint64_t kIncrement = 0x9e3779b97f4a7c15;

  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  }

  std::uint64_t state_;
};

}  // namespace fiimap::sim
