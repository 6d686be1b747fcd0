// SPDX-License-Identifier: Apache-2.0
// The memory of one run: what the engine asks for, and what the server holds for it besides, out of
// one share of the MemoryGate.
//
//   RunMemory memory(place.memory(), bytes_of_request);
//   context.set_memory(memory, memory.granted());
//
// Thread-safety: `grant` may be called by several threads; `tell_beyond` before all of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include "engine/base/context.h"
#include "engine/base/memory_source.h"
#include "server/admission/memory_gate.h"

namespace weft::server {

class RunMemory final : public MemorySource {
 public:
  // `besides` are the bytes that the server holds for the run: the request, and chunks that wait
  // for their reader. The share outlives this.
  RunMemory(MemoryGate::Share& share, std::uint64_t besides) : share_(share), besides_(besides) {}

  // What the engine may take without asking.
  std::uint64_t granted() const {
    const std::uint64_t all = share_ ? share_.bytes() : kAll;
    const std::uint64_t granted = all - std::min(all, besides_);
    return std::min(granted, told_beyond_);
  }

  // Calls `f` once the engine needs more than so many bytes, before it has them.
  void tell_beyond(std::uint64_t bytes, std::function<void()> f) {
    told_beyond_ = bytes;
    tell_ = std::move(f);
  }

  Result<std::uint64_t> grant(std::uint64_t needed, const ExecutionContext& run) override {
    if (tell_ && needed > told_beyond_ && !told_.exchange(true)) tell_();
    if (!share_) return kAll;
    if (auto error = share_.grow_to(besides_ + needed, [&run] { return run.poll(); }))
      return tl::unexpected(*error);
    const std::uint64_t granted = share_.bytes() - besides_;
    return tell_ && !told_ ? std::max(needed, std::min(granted, told_beyond_)) : granted;
  }

 private:
  static constexpr std::uint64_t kAll = std::numeric_limits<std::int64_t>::max();

  MemoryGate::Share& share_;
  const std::uint64_t besides_;
  std::uint64_t told_beyond_ = kAll;
  std::function<void()> tell_;
  std::atomic<bool> told_{false};
};

}  // namespace weft::server
