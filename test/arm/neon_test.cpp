#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "fiimap/kernels.h"

namespace fiimap {
namespace {

/// Without it, the other tests could pass with the plain kernels alone.
TEST(KernelsOnArmTest, AreInNeonInstructions) {
  ASSERT_EQ(std::getenv("FIIMAP_SIMD"), nullptr) << "the environment chooses the kernels";
  EXPECT_EQ(std::string(kernels().name).substr(0, 4), "NEON");
}

}  // namespace
}  // namespace fiimap
