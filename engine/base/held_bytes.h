// SPDX-License-Identifier: Apache-2.0
// Counts bytes that several threads take and give back, and their peak. Thread-safe.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace weft {

class HeldBytes {
 public:
  // Holds `bytes` while it lives.
  class Scope {
   public:
    Scope(HeldBytes& held, std::uint64_t bytes) : held_(held), bytes_(bytes) { held_.add(bytes_); }
    ~Scope() { held_.remove(bytes_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

    // Does nothing if `bytes` is not more. One thread at a time may call it.
    void grow_to(std::uint64_t bytes) {
      if (bytes > bytes_) held_.add(bytes - std::exchange(bytes_, bytes));
    }

   private:
    HeldBytes& held_;
    std::uint64_t bytes_;
  };

  void add(std::uint64_t bytes) {
    const std::uint64_t now = now_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    for (std::uint64_t peak = peak_.load(std::memory_order_relaxed); peak < now;) {
      if (peak_.compare_exchange_weak(peak, now, std::memory_order_relaxed)) break;
    }
  }
  // REQUIRES: nobody holds any.
  void clear() {
    now_.store(0, std::memory_order_relaxed);
    peak_.store(0, std::memory_order_relaxed);
  }
  void remove(std::uint64_t bytes) { now_.fetch_sub(bytes, std::memory_order_relaxed); }
  std::uint64_t now() const { return now_.load(std::memory_order_relaxed); }
  std::uint64_t peak() const { return peak_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> now_{0};
  std::atomic<std::uint64_t> peak_{0};
};

}  // namespace weft
