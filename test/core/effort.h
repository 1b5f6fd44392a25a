#pragma once

#include <algorithm>
#include <cstdlib>

namespace fiimap::test {

/// How many random cases a property test tries: `cases`, or the percentage of them that the
/// environment variable FIIMAP_TEST_PERCENT names, for slow machines; at least one.
inline int effort(int cases) {
  const char* const percent = std::getenv("FIIMAP_TEST_PERCENT");
  return percent == nullptr ? cases : std::max(1, cases * std::atoi(percent) / 100);
}

}  // namespace fiimap::test
