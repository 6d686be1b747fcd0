// SPDX-License-Identifier: Apache-2.0
// The gate that every call passes: it counts calls inside, can be closed to new ones, and reports
// when the last one has left.
//
//   auto pass = gate.enter();
//   if (!pass) return refuse();     // the server drains
//   ... the pass travels with the call and leaves the gate with it
//
// Thread-safety: every function may be called from any thread. A gate outlives its passes.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

namespace weft::server {

class DrainGate {
 public:
  class Pass {
   public:
    explicit Pass(DrainGate& gate) : gate_(&gate) {}
    Pass(Pass&& other) noexcept : gate_(std::exchange(other.gate_, nullptr)) {}
    Pass& operator=(Pass&&) = delete;
    ~Pass() {
      if (gate_ != nullptr) gate_->leave();
    }

   private:
    DrainGate* gate_;
  };

  // Returns nullopt once the gate is closed.
  std::optional<Pass> enter();

  void close();

  // Returns true once no call is inside, false if that takes longer than `at_most`.
  bool wait_empty(std::chrono::steady_clock::duration at_most);

 private:
  void leave();

  std::mutex mutex_;  // guards the two below
  std::size_t inside_ = 0;
  bool closed_ = false;
  std::condition_variable left_;
};

}  // namespace weft::server
