// SPDX-License-Identifier: Apache-2.0
// Hands out the numbers of blocks. Thread-safe. A block is taken once in a few hundred insertions,
// so a mutex is good enough.
//
// A thread gets its blocks in runs, so that one thread fills adjacent blocks: if two threads took
// blocks in turn, the processor would prefetch what the other thread is writing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace weft {

class BlockPool {
 public:
  static constexpr std::uint32_t kRun = 16;

  // Blocks below `taken` are taken already.
  BlockPool(std::uint32_t taken, std::uint32_t capacity)
      : fresh_(taken), capacity_(capacity), taken_(taken), peak_(taken) {}

  // Returns nullopt if this thread's run is used up and there is no other.
  std::optional<std::uint32_t> take() {
    const std::lock_guard lock(mutex_);
    Run& run = run_of(std::this_thread::get_id());
    if (run.size == 0) refill(run);
    if (run.size == 0) return std::nullopt;
    peak_ = std::max(peak_, ++taken_);
    return run.blocks[--run.size];
  }

  void give_back(std::uint32_t block) {
    const std::lock_guard lock(mutex_);
    free_.push_back(block);
    --taken_;
  }

  std::uint32_t capacity() const { return capacity_; }
  // The largest number of blocks taken at the same time.
  std::uint32_t peak() const {
    const std::lock_guard lock(mutex_);
    return peak_;
  }

 private:
  // The blocks that a thread takes next, the last one first.
  struct Run {
    std::thread::id thread;
    std::uint32_t size = 0;
    std::array<std::uint32_t, kRun> blocks{};
  };

  // REQUIRES, both: the mutex is held.
  Run& run_of(std::thread::id thread) {
    const auto run =
        std::find_if(runs_.begin(), runs_.end(), [&](const Run& r) { return r.thread == thread; });
    if (run != runs_.end()) return *run;
    runs_.emplace_back().thread = thread;
    return runs_.back();
  }
  // Refills with the blocks given back last, or else with fresh ones up to a multiple of kRun, if
  // there are any.
  void refill(Run& run) {
    if (!free_.empty()) {
      run.size = static_cast<std::uint32_t>(std::min<std::size_t>(kRun, free_.size()));
      std::copy(free_.end() - run.size, free_.end(), run.blocks.begin());
      free_.resize(free_.size() - run.size);
      return;
    }
    const std::uint32_t end = std::min(capacity_, (fresh_ / kRun + 1) * kRun);
    for (std::uint32_t block = end; block-- > fresh_;) run.blocks[run.size++] = block;
    fresh_ = end;
  }

  mutable std::mutex mutex_;  // guards all below
  std::uint32_t fresh_;       // from here on no block was ever handed out
  const std::uint32_t capacity_;
  std::uint32_t taken_;
  std::uint32_t peak_;
  std::vector<std::uint32_t> free_;
  std::vector<Run> runs_;
};

}  // namespace weft
