// SPDX-License-Identifier: Apache-2.0
// Lets long loops stop: polls cancellation, deadline and the byte budget every kStepsPerPoll steps.
//
// Inside engine/domain a stop travels as the exception `Stopped`, because it leaves from the depth
// of nested loops and nothing half-built is worth keeping; `triangulate` turns it into an Error, so
// it never crosses the library's border. Not thread-safe: one poller, one thread.
#pragma once

#include <cstdint>
#include <string>

#include "engine/base/context.h"
#include "weft/error.h"

namespace weft {

struct Stopped {
  Error error;
};

class StopPoller {
 public:
  explicit StopPoller(const ExecutionContext& context) : context_(context) {}

  // One step of work, at most about 10 microseconds. Throws Stopped.
  void step() {
    if (++steps_ % kStepsPerPoll == 0) [[unlikely]]
      poll();
  }

  // Throws Stopped. Not inlined, so that `step` is: calls of it took 2 % of a triangulation.
  [[gnu::noinline, gnu::cold]] void poll() const {
    if (auto error = context_.poll()) throw Stopped{*error};
  }

  // Throws Stopped with kBudgetExceeded if `bytes`, an estimate of the peak, is over the budget, or
  // with the error that need_bytes returns.
  void require(std::uint64_t bytes) const {
    if (auto error = context_.need_bytes(bytes, "triangulating the domain")) throw Stopped{*error};
  }

 private:
  static constexpr std::uint32_t kStepsPerPoll = 256;

  const ExecutionContext& context_;
  std::uint32_t steps_ = 0;
};

}  // namespace weft
