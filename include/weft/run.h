// SPDX-License-Identifier: Apache-2.0
// A run of the engine as its caller controls it: threads, memory, deadline, cancellation, progress.
//
//   ThreadPool pool(4);
//   Run run(Budget{.max_bytes = 1 << 30});
//   run.set_threads(pool);
//   Result<Summary> done = stream(request, sink, run);  // meanwhile, elsewhere: run.cancel()
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "weft/error.h"

namespace weft {

class Arena;
class ExecutionContext;

enum class Stage : std::uint8_t { kQueued, kTriangulate, kSize, kRefine, kDone };

// A snapshot for observers. `expected_triangles` is an estimate from the size field.
struct Progress {
  Stage stage = Stage::kQueued;
  std::uint64_t triangles = 0;
  std::uint64_t expected_triangles = 0;
  double fraction = 0;  // of the work that is done, 0 to 1; never falls
};

// What a run may use. DEFAULT: unbounded.
struct Budget {
  // Triangles of the mesh. Refinement stops there and returns the mesh that it has; triangles that
  // still miss a bound are counted as `budget` in the summary.
  std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max();
  // A run whose estimate is over this is refused before refinement, and one that grows past it
  // stops with kLimitExceeded. The operator sets this cap, the client sets max_triangles.
  std::uint64_t triangle_limit = std::numeric_limits<std::uint64_t>::max();
  // Bytes of engine memory. Over it the run stops with kBudgetExceeded.
  std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
};

// Where runs that share some memory get it from, each within its budget.
class MemorySource {
 public:
  // The error to stop with, if the run has to.
  using Poll = std::function<std::optional<Error>()>;

  virtual ~MemorySource() = default;
  // The run holds, or is about to hold, `needed` bytes in all. Returns how many it may hold from
  // now on, at least `needed`, or the error to stop with. May wait, and polls meanwhile. Called on
  // the run's threads, several at once. Law: granting, refusing and waiting change nothing in a
  // mesh that is made.
  virtual Result<std::uint64_t> grant(std::uint64_t needed, const Poll& poll) = 0;
};

// Threads that compute, for any number of runs at the same time. Thread-safe.
class ThreadPool {
 public:
  // REQUIRES: threads >= 1.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  int threads() const;

 private:
  friend class Run;
  std::unique_ptr<Arena> arena_;
};

// Thread-safety: cancel, poll, progress and pulse may be called from any thread at any time, the
// rest only while the engine does not work on the run. A stop is noticed within 50 ms.
class Run {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Run(const Budget& budget = {});
  ~Run();

  void set_deadline(Clock::time_point deadline) noexcept;
  // Where the run computes; the caller's own thread without a pool. The pool outlives the run,
  // which takes at most `threads` of it at a time; 0 is all.
  void set_threads(ThreadPool& pool, int threads = 0) noexcept;
  // The source outlives the run, which has `granted` bytes already.
  void set_memory(MemorySource& source, std::uint64_t granted) noexcept;
  // Forgets what the run did, so that it may begin again, with other settings. A cancellation
  // stays.
  void begin_again() noexcept;

  void cancel() noexcept;
  // Nothing while the run may go on, otherwise the error that it stops with.
  std::optional<Error> poll() const;
  Progress progress() const noexcept;
  // Changes while the run makes progress, and stays the same if it is stuck.
  std::uint64_t pulse() const noexcept;

  // The engine's own side of the run.
  ExecutionContext& context() noexcept { return *context_; }

 private:
  std::unique_ptr<ExecutionContext> context_;
};

}  // namespace weft
