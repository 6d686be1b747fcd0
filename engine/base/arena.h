// SPDX-License-Identifier: Apache-2.0
// The threads that compute. This is the only header that knows TBB; all else speaks of an Arena.
//
// One arena serves a process: whatever the number of runs, at most its threads compute at the same
// time, so a container's CPU quota is kept. Thread-safe.
//
//   Arena arena(4);
//   arena.run([&] { refine(); });      // on one of the four, the caller waits
//   arena.start([&] { refine(); });    // the caller goes on
//   arena.for_each(9, 2, [&](int i) { refine(i); });   // on two, the caller waits
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

#include "engine/base/tsan_hints.h"

namespace weft {

class Arena {
 public:
  // REQUIRES: threads >= 1.
  explicit Arena(int threads)
      : threads_(threads),
        workers_(at_most(threads + kMostResting)),
        arena_(threads + kMostResting, kReservedForCallers) {
    arena_.initialize();  // TBB warns if an arena is larger than allowed
    workers_ = at_most(threads);
  }

  int threads() const { return threads_; }

  // Ends the threads of the process's arenas, if none is left: new arenas get new ones. A child of
  // fork has no threads, but TBB would go on to count on those that its parent had.
  static void end_threads() noexcept {
    tbb::task_scheduler_handle handle{tbb::attach{}};
    tbb::finalize(handle, std::nothrow);
  }

  // Runs f in the arena once a slot is free, and returns when it is done; at once if the caller
  // is in the arena already. Throws what f throws.
  //
  // A caller from outside only waits. If its thread took the slot, there would be one thread more
  // than processors, and two of them would share a processor for up to 4 ms after the caller's
  // thread went to sleep.
  template <class F>
  auto run(F&& f) {
    if (inside_ == this) return f();
    std::packaged_task<decltype(f())()> task(std::ref(f));
    Signal done;
    start([&] {
      task();
      done.give();
    });
    done.wait();
    return task.get_future().get();
  }

  // Calls f(0) to f(n - 1) in any order, at most `threads` at the same time. Throws what f throws.
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

  // Returns f(), which waits for something outside the arena. If the caller is one of the arena's
  // threads, another thread computes in its place meanwhile, for up to kMostResting callers at a
  // time. When f returns, the caller computes at once, so for a while one thread more computes than
  // the arena has.
  template <class F>
  auto rest(F&& f) {
    if (inside_ != this) return f();
    const Rest rest(*this);
    return f();
  }

 private:
  static constexpr unsigned kReservedForCallers = 0;
  static constexpr int kMostResting = 64;

  // TBB counts the calling thread, which only waits here; and by default it makes no more threads
  // than the machine has.
  using Workers = std::unique_ptr<tbb::global_control>;
  static Workers at_most(int threads) {
    return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                 static_cast<std::size_t>(threads) + 1);
  }

  // May be destroyed as soon as `wait` returns, unlike a future's state, of which the giver may
  // still hold a part.
  class Signal {
   public:
    void give() {
      const std::lock_guard lock(mutex_);
      given_ = true;
      given_now_.notify_one();  // under the lock: see above
    }
    void wait() {
      std::unique_lock lock(mutex_);
      given_now_.wait(lock, [this] { return given_; });
    }

   private:
    std::mutex mutex_;  // guards the flag
    bool given_ = false;
    std::condition_variable given_now_;
  };

  // A thread rests while this lives. TBB applies the lowest of several limits: a new one takes
  // effect once the old one is gone, or at once if it is lower.
  class Rest {
   public:
    explicit Rest(Arena& arena) : arena_(arena) { arena_.change_resting(1); }
    ~Rest() { arena_.change_resting(-1); }
    Rest(const Rest&) = delete;
    Rest& operator=(const Rest&) = delete;

   private:
    Arena& arena_;
  };
  void change_resting(int by) {
    const std::lock_guard lock(mutex_);
    resting_ += by;
    workers_ = at_most(threads_ + std::min(resting_, kMostResting));
  }

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

  const int threads_;
  std::mutex mutex_;  // guards the two below
  int resting_ = 0;
  Workers workers_;
  tbb::task_arena arena_;
};

}  // namespace weft
