// SPDX-License-Identifier: GPL-3.0-or-later
// The threads that compute. This is the only header that knows TBB; all else speaks of an Arena.
//
// One arena serves a process: however many jobs there are, no more than its threads compute at
// the same time, so a container's CPU quota is kept. Thread-safe.
//
//   Arena arena(4);
//   arena.run([&] { refine(); });   // on one of the four, the caller waits
#pragma once

#include <tbb/task_arena.h>

#include <utility>

namespace weft {

class Arena {
 public:
  // REQUIRES: threads >= 1.
  explicit Arena(int threads) : arena_(threads) {}

  int threads() const { return arena_.max_concurrency(); }

  // Runs f in the arena once a slot is free, and returns when it is done. The caller's own thread
  // takes the slot when it can.
  template <class F>
  auto run(F&& f) {
    return arena_.execute(std::forward<F>(f));
  }

 private:
  tbb::task_arena arena_;
};

}  // namespace weft
