// SPDX-License-Identifier: Apache-2.0
#include "server/net/drain_gate.h"

namespace weft::server {

std::optional<DrainGate::Pass> DrainGate::enter() {
  std::lock_guard lock(mutex_);
  if (closed_) return std::nullopt;
  ++inside_;
  return std::optional<Pass>(std::in_place, *this);
}

void DrainGate::close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
}

bool DrainGate::wait_empty(std::chrono::steady_clock::duration at_most) {
  std::unique_lock lock(mutex_);
  return left_.wait_for(lock, at_most, [this] { return inside_ == 0; });
}

void DrainGate::leave() {
  std::lock_guard lock(mutex_);
  --inside_;
  left_.notify_all();  // under the lock: the gate may be destroyed once it is seen empty
}

}  // namespace weft::server
