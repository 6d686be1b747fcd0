// SPDX-License-Identifier: Apache-2.0
// The threads that compute. Only arena.cpp knows TBB; all else speaks of an Arena.
//
// One arena serves a process: whatever the number of runs, at most its threads compute at the same
// time, so a container's CPU quota is kept. Thread-safe.
//
//   Arena arena(4);
//   arena.run([&] { refine(); });      // on one of the four, the caller waits
//   arena.start([&] { refine(); });    // the caller goes on
//   arena.for_each(9, 2, [&](int i) { refine(i); });   // on two, the caller waits
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace weft {

class Arena {
 public:
  // REQUIRES: threads >= 1.
  explicit Arena(int threads);
  ~Arena();

  int threads() const { return threads_; }

  // Ends the threads of the process's arenas, if none is left: new arenas get new ones. A child of
  // fork has no threads, but TBB would go on to count on those that its parent had.
  static void end_threads() noexcept;

  // Runs f in the arena once a slot is free, and returns when it is done; at once if the caller
  // is in the arena already. Throws what f throws.
  //
  // A caller from outside only waits. If its thread took the slot, there would be one thread more
  // than processors, and two of them would share a processor for up to 4 ms after the caller's
  // thread went to sleep.
  template <class F>
  auto run(F&& f) {
    using R = std::invoke_result_t<F>;
    if (is_inside()) return f();
    if constexpr (std::is_void_v<R>) {
      run_and_wait([&f] { f(); });
    } else {
      std::optional<R> result;
      run_and_wait([&] { result.emplace(f()); });
      return *std::move(result);
    }
  }

  // Calls f(0) to f(n - 1) in any order, at most `threads` at the same time. Throws what f throws.
  template <class F>
  void for_each(std::size_t n, int threads, F&& f) {
    std::atomic<std::size_t> next{0};
    run_on(threads, [&] {
      for (std::size_t i = next++; i < n; i = next++) f(i);
    });
  }

  // Runs f in the arena once a slot is free: first come, first served. REQUIRES: f throws nothing.
  void start(std::function<void()> f);

  // Returns f(), which waits for something outside the arena. If the caller is one of the arena's
  // threads, another thread computes in its place meanwhile, for up to kMaxResting callers at a
  // time. When f returns, the caller computes at once, so for a while one thread more computes than
  // the arena has.
  template <class F>
  auto rest(F&& f) {
    if (!is_inside()) return f();
    const Rest rest(*this);
    return f();
  }

 private:
  static constexpr int kMaxResting = 64;

  struct Threads;

  // A thread rests while this lives.
  class Rest {
   public:
    explicit Rest(Arena& arena) : arena_(arena) { arena_.change_resting(1); }
    ~Rest() { arena_.change_resting(-1); }
    Rest(const Rest&) = delete;
    Rest& operator=(const Rest&) = delete;

   private:
    Arena& arena_;
  };

  // Whether the caller is one of the arena's threads.
  bool is_inside() const noexcept;
  void run_and_wait(const std::function<void()>& f);
  // Calls f so many times, at the same time where threads are free.
  void run_on(int threads, const std::function<void()>& f);
  void change_resting(int by);

  const int threads_;
  const std::unique_ptr<Threads> pool_;
};

}  // namespace weft
