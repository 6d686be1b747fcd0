// SPDX-License-Identifier: Apache-2.0
// The memory of one run: what the engine asks for, and what the server holds for it besides, out of
// one share of the MemoryGate.
//
//   RunMemory memory(slot.memory(), bytes_of_request);
//   run.set_memory(memory, memory.granted());
//
// Thread-safety: `grant` may be called by several threads, the rest while the engine does not run.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

#include "server/run/memory_gate.h"
#include "weft/run.h"

namespace weft::server {

class RunMemory final : public MemorySource {
 public:
  // `besides` are the bytes that the server holds for the run: the request, and chunks that wait
  // for their reader. The share outlives this.
  RunMemory(MemoryGate::Share& share, std::uint64_t besides) : share_(share), besides_(besides) {}

  // What the engine may take without asking.
  std::uint64_t granted() const {
    const std::uint64_t all = share_ ? share_.bytes() : kAll;
    return std::min(all - std::min(all, besides_), limit_);
  }

  // The engine gets no more than so many bytes: a run that needs more fails.
  void limit_to(std::uint64_t bytes) { limit_ = bytes; }
  // Whether a run failed because of that.
  bool limit_was_reached() const { return limit_was_reached_; }
  // For a run that begins again, without the limit: gives back what the engine had.
  void begin_again() {
    limit_ = kAll;
    share_.shrink_to(besides_);
  }

  Result<std::uint64_t> grant(std::uint64_t needed, const Poll& poll) override {
    if (needed > limit_) {
      limit_was_reached_ = true;
      return fail(ErrorCode::kOutOfMemory, "", "the run needs more memory than a light one");
    }
    if (!share_) return limit_;
    if (auto error = share_.grow_to(besides_ + needed, poll)) return tl::unexpected(*error);
    return granted();
  }

 private:
  static constexpr std::uint64_t kAll = std::numeric_limits<std::int64_t>::max();

  MemoryGate::Share& share_;
  const std::uint64_t besides_;
  std::uint64_t limit_ = kAll;
  std::atomic<bool> limit_was_reached_{false};
};

}  // namespace weft::server
