// SPDX-License-Identifier: Apache-2.0
// The one thing that travels with a run: cancellation, deadline, budgets, progress, and where it
// computes.
//
// Thread-safety: `cancel` and `progress` may be called from any thread at any time; the setters
// only before the run starts. Running code calls `poll` at least every few milliseconds (the
// kernel: every 512 insertions, about 0.1 ms), so a stop is noticed within 50 ms. If the run is
// cancelled and past its deadline, the cancellation wins.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/base/arena.h"
#include "engine/base/held_bytes.h"
#include "engine/base/trace.h"
#include "weft/error.h"
#include "weft/run.h"

namespace weft {

class ExecutionContext {
 public:
  using Clock = std::chrono::steady_clock;

  ExecutionContext() = default;
  explicit ExecutionContext(const Budget& budget) : budget_(budget) {}
  // For a run inside another one, which waits for it: it stops when that one has to, computes where
  // that one does, and gets its memory from there. Its progress is its own. REQUIRES: `outer`
  // outlives it and holds no memory meanwhile.
  ExecutionContext(const ExecutionContext& outer, const Budget& budget)
      : budget_(budget), arena_(outer.arena_), threads_(outer.threads_), outer_(&outer) {}
  ExecutionContext(const ExecutionContext&) = delete;
  ExecutionContext& operator=(const ExecutionContext&) = delete;

  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  void set_deadline(Clock::time_point deadline) noexcept { deadline_ = deadline; }
  // Where the run computes; the caller's own thread without one. The arena outlives the run. The
  // run takes at most `threads` of it at a time; 0 is all.
  void set_arena(Arena& arena, int threads = 0) noexcept {
    arena_ = &arena;
    threads_ = threads > 0 ? std::min(threads, arena.threads()) : arena.threads();
  }
  // Where the run records what it does and when. The trace must outlive the run.
  void set_trace(Trace& trace) noexcept { trace_ = &trace; }
  // Where the run gets its memory from, within its budget. The source must outlive the run, which
  // has `granted` bytes already.
  void set_memory(MemorySource& source, std::uint64_t granted) noexcept {
    memory_ = &source;
    granted_.store(granted, std::memory_order_relaxed);
  }
  // Forgets what the run did, so that it may begin again, with other settings. A cancellation
  // stays. REQUIRES: no thread works on the run.
  void begin_again() noexcept {
    least_fraction_.store(progress().fraction, std::memory_order_relaxed);
    granted_.store(0, std::memory_order_relaxed);
    held_.clear();
    stage_.store(Stage::kQueued, std::memory_order_relaxed);
    triangles_.store(0, std::memory_order_relaxed);
    expected_.store(0, std::memory_order_relaxed);
    fraction_.store(0, std::memory_order_relaxed);
    share_of_triangles_.store(0, std::memory_order_relaxed);
  }
  const Budget& budget() const noexcept { return budget_; }

  // Returns nullopt while the run may go on, otherwise the error to stop with.
  std::optional<Error> poll() const {
    pulse_.store(pulse_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (outer_ != nullptr) return outer_->poll();
    if (cancelled_.load(std::memory_order_relaxed))
      return Error{ErrorCode::kCancelled, "", "the run was cancelled"};
    if (deadline_ && Clock::now() >= *deadline_)
      return Error{ErrorCode::kDeadlineExceeded, "", "the run's deadline passed"};
    return std::nullopt;
  }

  // Call it with all bytes that the run holds, or is about to hold, and what takes them: "the
  // mesh". Waits until they are granted; returns the error to stop with if they are over the budget
  // or will not be granted. Thread-safe.
  std::optional<Error> need_bytes(std::uint64_t bytes, std::string_view what) const {
    if (bytes > budget_.max_bytes) {
      return Error{ErrorCode::kBudgetExceeded, "budget.max_bytes",
                   std::string(what) + " takes about " + std::to_string(bytes) +
                       " bytes with all that the run holds, the budget is " +
                       std::to_string(budget_.max_bytes)};
    }
    if (outer_ != nullptr) return outer_->need_bytes(bytes, what);
    if (memory_ == nullptr || bytes <= granted_.load(std::memory_order_relaxed))
      return std::nullopt;
    const auto ask = [&] { return memory_->grant(bytes, [this] { return poll(); }); };
    const Result<std::uint64_t> now = arena_ ? arena_->rest(ask) : ask();
    if (!now) return now.error();
    std::uint64_t before = granted_.load(std::memory_order_relaxed);
    while (before < *now &&
           !granted_.compare_exchange_weak(before, *now, std::memory_order_relaxed)) {
    }
    return std::nullopt;
  }

  // What the run holds besides the mesh and what does not change while it is refined. Thread-safe.
  HeldBytes& held_bytes() noexcept { return held_; }

  // Changes while the run makes progress, and stays the same if it is stuck. Thread-safe.
  std::uint64_t pulse() const noexcept { return pulse_.load(std::memory_order_relaxed); }

  Progress progress() const noexcept {
    Progress now{stage_.load(std::memory_order_relaxed), triangles_.load(std::memory_order_relaxed),
                 expected_.load(std::memory_order_relaxed),
                 fraction_.load(std::memory_order_relaxed)};
    now.fraction +=
        share_of_triangles_.load(std::memory_order_relaxed) *
        std::min(1.0, static_cast<double>(now.triangles) /
                          static_cast<double>(std::max<std::uint64_t>(now.expected_triangles, 1)));
    now.fraction = std::clamp(now.fraction, least_fraction_.load(std::memory_order_relaxed), 1.0);
    return now;
  }

  // For the engine at work.
  Arena* arena() const noexcept { return arena_; }
  int threads() const noexcept { return threads_; }
  Trace* trace() const noexcept { return trace_; }
  void end_stage(const char* name) const {
    if (trace_) trace_->end_stage(name);
  }
  template <class F>
  auto compute(F&& f) const {
    return arena_ ? arena_->run(std::forward<F>(f)) : f();
  }
  // Calls f(0) to f(n - 1), on as many threads as the run may take.
  template <class F>
  void for_each(std::size_t n, F&& f) const {
    if (arena_ && threads_ > 1) {
      arena_->for_each(n, static_cast<int>(std::min<std::size_t>(n, threads_)), std::forward<F>(f));
    } else if (trace_) {
      trace_->time_loop(n, std::forward<F>(f));
    } else {
      for (std::size_t i = 0; i < n; ++i) f(i);
    }
  }
  void enter(Stage stage) noexcept { stage_.store(stage, std::memory_order_relaxed); }
  // Returns the new number of triangles. Thread-safe.
  std::uint64_t add_triangles(std::int64_t n) noexcept {
    const auto delta = static_cast<std::uint64_t>(n);
    return triangles_.fetch_add(delta, std::memory_order_relaxed) + delta;
  }
  std::uint64_t triangles() const noexcept { return triangles_.load(std::memory_order_relaxed); }
  // Thread-safe.
  void add_fraction(double f) noexcept { fraction_.fetch_add(f, std::memory_order_relaxed); }
  // This part of the work counts as done in proportion to the triangles made.
  void count_triangles_as(double part) noexcept {
    share_of_triangles_.store(part, std::memory_order_relaxed);
  }
  void report_expected(std::uint64_t n) noexcept { expected_.store(n, std::memory_order_relaxed); }

 private:
  Budget budget_;
  std::optional<Clock::time_point> deadline_;
  Arena* arena_ = nullptr;
  int threads_ = 1;
  Trace* trace_ = nullptr;
  MemorySource* memory_ = nullptr;
  const ExecutionContext* outer_ = nullptr;
  mutable std::atomic<std::uint64_t> granted_{0};
  HeldBytes held_;
  std::atomic<bool> cancelled_{false};
  mutable std::atomic<std::uint64_t> pulse_{0};  // about one for every poll
  std::atomic<Stage> stage_{Stage::kQueued};
  std::atomic<std::uint64_t> triangles_{0};
  std::atomic<std::uint64_t> expected_{0};
  std::atomic<double> least_fraction_{0};  // what was reported before the run began again
  std::atomic<double> fraction_{0};
  std::atomic<double> share_of_triangles_{0};
};

}  // namespace weft
