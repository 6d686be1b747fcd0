// SPDX-License-Identifier: Apache-2.0
// Tells ThreadSanitizer what TBB guarantees: the thread that runs a function sees what was written
// before the function was given to the arena, and a thread that waited for the function sees what
// the function wrote. ThreadSanitizer cannot see that itself, because Debian builds libtbb without
// it. In other builds these functions do nothing.
//
//   arena.enqueue(handed_over(f));
//   run_handed_over<int>(f, [&](auto&& g) { tbb::parallel_for(0, n, g); });
//
// Each hand-over has its own address, so the hints state nothing that TBB does not guarantee.
#pragma once

#include <utility>

#ifdef WEFT_THREAD_SANITIZER

#include <sanitizer/tsan_interface.h>

#include <memory>
#include <type_traits>

namespace weft {

template <class F>
class HandedOver {
 public:
  explicit HandedOver(F&& f) : f_(new std::decay_t<F>(std::forward<F>(f))) { __tsan_release(f_); }
  // The pointer itself travels through TBB.
  __attribute__((no_sanitize("thread"))) void operator()() const { run(f_); }

 private:
  static void run(std::decay_t<F>* f) {
    __tsan_acquire(f);
    const std::unique_ptr<std::decay_t<F>> owner(f);
    (*owner)();
  }
  std::decay_t<F>* f_;
};

template <class F>
auto handed_over(F&& f) {
  return HandedOver<F>(std::forward<F>(f));
}

// The function that TBB gets: it holds only pointers, and has a short name for the symbolizer.
template <class... Args>
struct Trampoline {
  void* call;
  void (*run)(void*, Args...);
  __attribute__((no_sanitize("thread"))) void operator()(Args... args) const { run(call, args...); }
};

// `execute` may call its argument with Args, several times, on any threads.
template <class... Args, class F, class Execute>
void run_handed_over(F&& f, Execute&& execute) {
  struct Call {
    std::decay_t<F>& f;
    static void run_on(void* self, Args... args) { static_cast<Call*>(self)->run(args...); }
    void run(Args... args) {
      __tsan_acquire(this);
      struct Release {
        Call* call;
        ~Release() { __tsan_release(call); }
      } release{this};
      f(args...);
    }
  } call{f};
  __tsan_release(&call);
  struct Acquire {
    Call* call;
    ~Acquire() { __tsan_acquire(call); }
  };
  const Acquire acquire{&call};
  execute(Trampoline<Args...>{&call, &Call::run_on});
}

}  // namespace weft

#else

namespace weft {

template <class F>
F&& handed_over(F&& f) {
  return std::forward<F>(f);
}

template <class... Args, class F, class Execute>
void run_handed_over(F&& f, Execute&& execute) {
  execute(std::forward<F>(f));
}

}  // namespace weft

#endif
