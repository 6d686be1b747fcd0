// SPDX-License-Identifier: Apache-2.0
// The threads that compute. This is the only header that knows TBB; all else speaks of an Arena.
//
// One arena serves a process: however many jobs there are, no more than its threads compute at
// the same time, so a container's CPU quota is kept. Thread-safe.
//
//   Arena arena(4);
//   arena.run([&] { refine(); });      // on one of the four, the caller waits
//   arena.start([&] { refine(); });    // the caller goes on
//   arena.for_each(9, 2, [&](int i) { refine(i); });   // on two, the caller waits
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "engine/handover.h"

namespace weft {

class Arena {
 public:
  // REQUIRES: threads >= 1.
  explicit Arena(int threads)
      : workers_(tbb::global_control::max_allowed_parallelism,
                 static_cast<std::size_t>(threads) + 1),
        arena_(threads, kReservedForCallers) {}

  int threads() const { return arena_.max_concurrency(); }

  // Runs f in the arena once a slot is free, and returns when it is done; at once where the caller
  // is in the arena already. What f throws, this throws.
  //
  // A caller from outside only waits. Were its thread to take the slot, there would be one thread
  // more than processors, and the system made two of them share one for up to 4 ms after the
  // caller went back to sleep: 2 % of the time of two threads at 1 M triangles.
  template <class F>
  auto run(F&& f) {
    if (inside_ == this) return f();
    const auto task = std::make_shared<std::packaged_task<decltype(f())()>>(std::ref(f));
    auto result = task->get_future();
    start([task] { (*task)(); });
    return result.get();
  }

  // Calls f(0) to f(n - 1) in any order, at most `threads` at the same time. What f throws, this
  // throws.
  template <class F>
  void for_each(std::size_t n, int threads, F&& f) {
    std::atomic<std::size_t> next{0};
    run_handed_over<int>(
        [&](int) {
          const Stay stay(this);
          for (std::size_t i = next++; i < n; i = next++) f(i);
        },
        [&](auto&& work) {
          run([&] { tbb::parallel_for(0, threads, work, tbb::simple_partitioner()); });
        });
  }

  // Runs f in the arena once a slot is free: first come, first served.
  template <class F>
  void start(F&& f) {
    arena_.enqueue(handed_over([this, f = std::forward<F>(f)] {
      const Stay stay(this);
      f();
    }));
  }

 private:
  static constexpr unsigned kReservedForCallers = 0;

  // A thread's time in an arena.
  class Stay {
   public:
    explicit Stay(const Arena* arena) : before_(std::exchange(inside_, arena)) {}
    ~Stay() { inside_ = before_; }
    Stay(const Stay&) = delete;
    Stay& operator=(const Stay&) = delete;

   private:
    const Arena* const before_;  // TBB may run a task while another one waits
  };
  static inline thread_local const Arena* inside_ = nullptr;

  // TBB counts the calling thread in, which here only waits; and by itself it makes no more threads
  // than the machine has.
  tbb::global_control workers_;
  tbb::task_arena arena_;
};

}  // namespace weft
