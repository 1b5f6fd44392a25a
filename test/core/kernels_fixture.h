#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "fiimap/kernels.h"
#include "oracle.h"

namespace fiimap {

inline void PrintTo(const Kernels* kernels, std::ostream* out) { *out << kernels->name; }

namespace test {

/// Every instruction set that this machine has computes the same bits as plain C++. That plain C++
/// is right, the tests of the classes that use it show.
class KernelsTest : public ::testing::TestWithParam<const Kernels*> {
 protected:
  static constexpr int kRounds = 300;

  float uniform(double low, double high) {
    return static_cast<float>(uniformReal(random_, low, high));
  }
  std::uint64_t randomWord() {
    const auto half = [&] { return static_cast<std::uint64_t>(random_()); };
    switch (uniformInt(random_, 0, 3)) {
      case 0:
        return 0;
      case 1:
        return ~std::uint64_t{0};
      default:
        return half() << 32 | half();
    }
  }

  const Kernels& tested_ = *GetParam();
  const Kernels& plain_ = plainKernels();
  Random random_{81};
};

/// For INSTANTIATE_TEST_SUITE_P.
inline std::string nameOfKernels(const ::testing::TestParamInfo<const Kernels*>& info) {
  return info.param->name;
}

}  // namespace test
}  // namespace fiimap
