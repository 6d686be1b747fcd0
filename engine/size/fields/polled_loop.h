// SPDX-License-Identifier: Apache-2.0
// A parallel loop that stops when the run must stop: f(0) to f(n - 1), on as many threads as the
// run may take, with a poll before each.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>

#include "engine/base/context.h"
#include "weft/error.h"

namespace weft {

// f returns nothing, or the error to stop with. Returns the first error; some calls of f are left
// out then. REQUIRES: f takes a few milliseconds at most, or polls, and does not throw.
template <class F>
std::optional<Error> polled_loop(const ExecutionContext& context, std::size_t n, F&& f) {
  std::mutex mutex;
  std::optional<Error> first;  // guarded by the mutex
  std::atomic<bool> stopped{false};
  context.for_each(n, [&](std::size_t i) {
    if (stopped.load(std::memory_order_relaxed)) return;
    std::optional<Error> error = context.poll();
    if (!error) {
      if constexpr (std::is_void_v<decltype(f(i))>)
        f(i);
      else
        error = f(i);
    }
    if (!error) return;
    const std::lock_guard lock(mutex);
    if (!first) first = std::move(error);
    stopped.store(true, std::memory_order_relaxed);
  });
  return first;
}

}  // namespace weft
