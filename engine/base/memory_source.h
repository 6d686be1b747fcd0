// SPDX-License-Identifier: Apache-2.0
// Where a run gets its memory from, if several runs share some.
//
// A run has a budget of its own (Budget::max_bytes). A caller with several runs at the same time
// may also grant each its memory as it grows: a run that needs more than it has asks, and waits.
#pragma once

#include <cstdint>

#include "engine/base/error.h"

namespace weft {

class ExecutionContext;

class MemorySource {
 public:
  virtual ~MemorySource() = default;

  // The run holds, or is about to hold, `needed` bytes in all. Returns how many it may hold from
  // now on, at least `needed`, or the error to stop with. May wait, and polls `run` meanwhile.
  // Called on the run's threads, several at once. Law: granting, refusing and waiting change
  // nothing in a mesh that is made.
  virtual Result<std::uint64_t> grant(std::uint64_t needed, const ExecutionContext& run) = 0;
};

}  // namespace weft
