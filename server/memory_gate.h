// SPDX-License-Identifier: Apache-2.0
// Memory is promised to jobs before they begin: a job that would need more than is left waits.
//
//   if (auto share = gate.take(weight)) ... the share travels with the job and goes back with it
//
// Law: a job that is alone gets its share, however heavy it is.
// Thread-safety: every function may be called from any thread. A gate outlives its shares.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace weft::server {

class MemoryGate {
 public:
  class Share {
   public:
    Share() = default;  // of nothing
    Share(Share&& other) noexcept
        : gate_(std::exchange(other.gate_, nullptr)), bytes_(other.bytes_) {}
    Share& operator=(Share&& other) noexcept {
      std::swap(gate_, other.gate_);
      std::swap(bytes_, other.bytes_);
      return *this;
    }
    ~Share() {
      if (gate_ != nullptr) gate_->give_back(bytes_);
    }

   private:
    friend class MemoryGate;
    Share(MemoryGate& gate, std::uint64_t bytes) : gate_(&gate), bytes_(bytes) {}

    MemoryGate* gate_ = nullptr;
    std::uint64_t bytes_ = 0;
  };

  // `on_room` is called, on any thread and without a lock, when bytes were given back.
  MemoryGate(std::uint64_t capacity, std::function<void()> on_room)
      : capacity_(capacity), on_room_(std::move(on_room)) {}

  // Nothing where less than that is left.
  std::optional<Share> take(std::uint64_t bytes) {
    std::lock_guard lock(mutex_);
    if (bytes > room_now()) return std::nullopt;
    taken_ += bytes;
    ++shares_;
    return Share(*this, bytes);
  }

  // The heaviest job that `take` admits now.
  std::uint64_t room() const {
    std::lock_guard lock(mutex_);
    return room_now();
  }

  std::uint64_t taken() const {
    std::lock_guard lock(mutex_);
    return taken_;
  }

 private:
  std::uint64_t room_now() const {
    if (shares_ == 0) return std::numeric_limits<std::int64_t>::max();
    return capacity_ - std::min(taken_, capacity_);
  }
  void give_back(std::uint64_t bytes) {
    {
      std::lock_guard lock(mutex_);
      taken_ -= bytes;
      --shares_;
    }
    on_room_();
  }

  const std::uint64_t capacity_;
  const std::function<void()> on_room_;
  mutable std::mutex mutex_;  // guards the two below
  std::uint64_t taken_ = 0;
  std::uint64_t shares_ = 0;
};

}  // namespace weft::server
