// SPDX-License-Identifier: Apache-2.0
// A parallel loop that stops when the job must stop: f(0) to f(n - 1), on as many threads as the
// job may take, with a poll before each.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>

#include "engine/base/context.h"
#include "engine/base/error.h"

namespace weft {

// Returns the error to stop with; some calls of f are left out then. REQUIRES: f takes a few
// milliseconds at most and does not throw.
template <class F>
std::optional<Error> polled_loop(const ExecutionContext& context, std::size_t n, F&& f) {
  std::mutex mutex;  // guards `error`
  std::optional<Error> error;
  std::atomic<bool> stopped{false};
  context.for_each(n, [&](std::size_t i) {
    if (stopped.load(std::memory_order_relaxed)) return;
    if (auto stop = context.poll()) {
      const std::lock_guard lock(mutex);
      error = std::move(stop);
      stopped.store(true, std::memory_order_relaxed);
      return;
    }
    f(i);
  });
  return error;
}

}  // namespace weft
