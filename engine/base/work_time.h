// SPDX-License-Identifier: Apache-2.0
// Sums the seconds of work of several threads. Thread-safe.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace weft {

class WorkTime {
 public:
  template <class F>
  auto measure(F&& f) {
    struct Stop {
      WorkTime& work;
      Clock::time_point start = Clock::now();
      ~Stop() {
        work.nanoseconds_.fetch_add(
            std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
      }
    } stop{*this};
    return f();
  }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

 private:
  using Clock = std::chrono::steady_clock;

  std::atomic<std::int64_t> nanoseconds_{0};
};

}  // namespace weft
