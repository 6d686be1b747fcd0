// SPDX-License-Identifier: Apache-2.0
// Processor time, which other programs hardly stretch: what bounds a time on a machine that may be
// busy. The bounds of tests are 20 times what a quiet machine of two cores takes, and slowdown()
// times as much; tests that try many inputs try as many times fewer.
#pragma once

#include <cstdlib>
#include <ctime>

namespace weft {

// Of this thread; of all threads of the process with CLOCK_PROCESS_CPUTIME_ID.
inline double processor_seconds(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// How many times as long everything takes here: TEST_SLOWDOWN of the environment, which qemu sets
// for arm64 (deploy/arm64/toolchain.cmake), or 1.
inline double slowdown() {
  const char* times = std::getenv("TEST_SLOWDOWN");
  return times ? std::strtod(times, nullptr) : 1;
}

}  // namespace weft
