// SPDX-License-Identifier: GPL-3.0-or-later
// The threads that compute. This is the only header that knows TBB; all else speaks of an Arena.
//
// One arena serves a process: however many jobs there are, no more than its threads compute at
// the same time, so a container's CPU quota is kept. Thread-safe.
//
//   Arena arena(4);
//   arena.run([&] { refine(); });     // on one of the four, the caller waits
//   arena.start([&] { refine(); });   // the caller goes on
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <utility>

namespace weft {

class Arena {
 public:
  // REQUIRES: threads >= 1.
  explicit Arena(int threads)
      : workers_(tbb::global_control::max_allowed_parallelism,
                 static_cast<std::size_t>(threads) + 1),
        arena_(threads, kReservedForCallers) {}

  int threads() const { return arena_.max_concurrency(); }

  // Runs f in the arena once a slot is free, and returns when it is done. The caller's own thread
  // takes the slot when it can.
  template <class F>
  auto run(F&& f) {
    return arena_.execute(std::forward<F>(f));
  }

  // Runs f in the arena once a slot is free: first come, first served.
  template <class F>
  void start(F&& f) {
    arena_.enqueue(std::forward<F>(f));
  }

 private:
  static constexpr unsigned kReservedForCallers = 0;

  // TBB counts the calling thread in, which here only waits; and by itself it makes no more threads
  // than the machine has.
  tbb::global_control workers_;
  tbb::task_arena arena_;
};

}  // namespace weft
