// SPDX-License-Identifier: Apache-2.0
#include "engine/base/arena.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>

#include "engine/base/tsan_hints.h"

namespace weft {
namespace {

constexpr unsigned kReservedForCallers = 0;

// The arena that the thread works in.
thread_local const Arena* inside = nullptr;

// A thread's time in an arena.
class Stay {
 public:
  explicit Stay(const Arena* arena) : before_(std::exchange(inside, arena)) {}
  ~Stay() { inside = before_; }
  Stay(const Stay&) = delete;
  Stay& operator=(const Stay&) = delete;

 private:
  const Arena* const before_;  // TBB may run a task while another one waits
};

// TBB counts the calling thread, which only waits here; and by default it makes no more threads
// than the machine has. It applies the lowest of several limits: a new one takes effect once the
// old one is gone, or at once if it is lower.
std::unique_ptr<tbb::global_control> at_most(int threads) {
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

}  // namespace

struct Arena::Threads {
  explicit Threads(int threads)
      : workers(at_most(threads + kMaxResting)), arena(threads + kMaxResting, kReservedForCallers) {
    arena.initialize();  // TBB warns if an arena is larger than allowed
    workers = at_most(threads);
  }

  std::mutex mutex;  // guards the two below
  int resting = 0;
  std::unique_ptr<tbb::global_control> workers;
  tbb::task_arena arena;
};

Arena::Arena(int threads) : threads_(threads), pool_(std::make_unique<Threads>(threads)) {}

Arena::~Arena() = default;

void Arena::end_threads() noexcept {
  tbb::task_scheduler_handle handle{tbb::attach{}};
  tbb::finalize(handle, std::nothrow);
}

bool Arena::is_inside() const noexcept {
  return inside == this;
}

void Arena::start(std::function<void()> f) {
  pool_->arena.enqueue(handed_over([this, f = std::move(f)] {
    const Stay stay(this);
    f();
  }));
}

void Arena::run_and_wait(const std::function<void()>& f) {
  std::exception_ptr thrown;
  Signal done;
  start([&] {
    try {
      f();
    } catch (...) {
      thrown = std::current_exception();
    }
    done.give();
  });
  done.wait();
  if (thrown != nullptr) std::rethrow_exception(std::move(thrown));
}

void Arena::run_on(int threads, const std::function<void()>& f) {
  run_handed_over<int>(
      [&](int) {
        const Stay stay(this);
        f();
      },
      [&](auto&& work) {
        run([&] { tbb::parallel_for(0, threads, work, tbb::simple_partitioner()); });
      });
}

void Arena::change_resting(int by) {
  const std::lock_guard lock(pool_->mutex);
  pool_->resting += by;
  pool_->workers = at_most(threads_ + std::min(pool_->resting, kMaxResting));
}

}  // namespace weft
