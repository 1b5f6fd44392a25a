#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

/// What the fuzzer calls with each input; also what the replay of the corpora calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fiimap::fuzz {

/// Ends the process, so that the fuzzer keeps the input. Unlike assert it is never compiled out.
inline void require(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz target: %s\n", what.c_str());
  std::abort();
}

/// Turns the fuzzer's bytes into values; zeros when they are used up.
class ByteSource {
 public:
  ByteSource(const std::uint8_t* data, std::size_t size) : next_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  template <typename Plain>
  Plain take() {
    Plain value{};
    const std::size_t bytes = std::min(sizeof(value), left_);
    if (bytes > 0) std::memcpy(&value, next_, bytes);
    next_ += bytes;
    left_ -= bytes;
    return value;
  }

  /// \param low, high both included, at most 65536 values.
  int integer(int low, int high) {
    const std::uint32_t count = static_cast<std::uint32_t>(high - low) + 1;
    const std::uint32_t drawn = count <= 256 ? take<std::uint8_t>() : take<std::uint16_t>();
    return low + static_cast<int>(drawn % count);
  }
  bool flag() { return (take<std::uint8_t>() & 1u) != 0; }
  /// On a grid of 65536 values, low and high included.
  double real(double low, double high) {
    constexpr double kSteps = 65535.0;
    return low + (high - low) * take<std::uint16_t>() / kSteps;
  }
  /// Mostly a harmless number; sometimes any double there is.
  double anyDouble(double low, double high) {
    constexpr std::uint8_t kWild = 240;
    return take<std::uint8_t>() >= kWild ? take<double>() : real(low, high);
  }
  /// Mostly a small number; sometimes any there is.
  std::uint32_t anySize(int low, int high) {
    constexpr std::uint8_t kWild = 240;
    return take<std::uint8_t>() >= kWild ? take<std::uint32_t>()
                                         : static_cast<std::uint32_t>(integer(low, high));
  }
  std::string text(std::size_t most) {
    std::string text(std::min<std::size_t>(take<std::uint8_t>(), std::min(most, left_)), '\0');
    for (char& c : text) c = take<char>();
    return text;
  }
  std::vector<std::uint8_t> bytes(std::size_t most) {
    const std::size_t count = std::min(most, left_);
    std::vector<std::uint8_t> taken(next_, next_ + count);
    next_ += count;
    left_ -= count;
    return taken;
  }

 private:
  const std::uint8_t* next_;
  std::size_t left_;
};

}  // namespace fiimap::fuzz
