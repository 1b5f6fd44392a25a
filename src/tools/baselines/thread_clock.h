#pragma once

#include <time.h>

namespace fiimap::bench {

/// CPU time of the calling thread, microseconds: unlike wall-clock time it does not count the time
/// that other processes take away. Reading it costs a system call, about 0.3 us.
inline double threadMicroseconds() {
  constexpr double kMicrosecondsPerSecond = 1e6;
  constexpr double kMicrosecondsPerNanosecond = 1e-3;
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * kMicrosecondsPerSecond +
         static_cast<double>(now.tv_nsec) * kMicrosecondsPerNanosecond;
}

/// CPU time of this thread that a call takes, microseconds.
template <typename Call>
double microsecondsOf(Call&& call) {
  const double start = threadMicroseconds();
  call();
  return threadMicroseconds() - start;
}

}  // namespace fiimap::bench
