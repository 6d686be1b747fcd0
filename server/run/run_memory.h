// SPDX-License-Identifier: Apache-2.0
// The memory of one run, out of its reservation in the MemoryBudget: what the engine asks for, and
// what the server holds for the run besides.
//
//   RunMemory memory(slot.memory(), bytes_of_request);
//   run.set_memory(memory, memory.granted());
//
// Units: bytes. Thread-safety: `grant` may be called by several threads, the other functions while
// the engine does not run.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

#include "server/run/memory_budget.h"
#include "weft/run.h"

namespace weft::server {

class RunMemory final : public MemorySource {
 public:
  // The server holds `besides` bytes for the run: the request, and chunks that wait for their
  // reader. The reservation outlives this; if it is empty, memory is not bounded.
  RunMemory(MemoryBudget::Reservation& reservation, std::uint64_t besides)
      : reservation_(reservation), besides_(besides) {}

  // The bytes that the engine may use without a call of `grant`.
  std::uint64_t granted() const {
    const std::uint64_t all = reservation_ ? reservation_.bytes() : kAll;
    return std::min(all - std::min(all, besides_), limit_);
  }

  // Bounds the engine's bytes: a run that needs more fails.
  void limit_to(std::uint64_t bytes) { limit_ = bytes; }
  // Whether a run failed because of limit_to.
  bool limit_was_reached() const { return limit_was_reached_; }
  // For a run that begins again, without the limit: releases the bytes that the engine had.
  void begin_again() {
    limit_ = kAll;
    reservation_.shrink_to(besides_);
  }

  Result<std::uint64_t> grant(std::uint64_t needed, const Poll& poll) override {
    if (needed > limit_) {
      limit_was_reached_ = true;
      return fail(ErrorCode::kOutOfMemory, "", "the run needs more memory than a light one");
    }
    if (!reservation_) return limit_;
    if (auto error = reservation_.grow_to(besides_ + needed, poll)) return tl::unexpected(*error);
    return granted();
  }

 private:
  static constexpr std::uint64_t kAll = std::numeric_limits<std::int64_t>::max();

  MemoryBudget::Reservation& reservation_;
  const std::uint64_t besides_;
  std::uint64_t limit_ = kAll;
  std::atomic<bool> limit_was_reached_{false};
};

}  // namespace weft::server
