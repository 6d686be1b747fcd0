// SPDX-License-Identifier: Apache-2.0
// Something that happens once, for threads to wait for.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace weft {

// Long enough for any machine; nothing waits as long unless it is broken.
inline constexpr std::chrono::seconds kPatience{60};

class Event {
 public:
  void set() {
    const std::lock_guard lock(mutex_);
    happened_ = true;
    changed_.notify_all();
  }
  bool happened() {
    const std::lock_guard lock(mutex_);
    return happened_;
  }
  // False when it did not happen within kPatience.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return happened_; });
  }

 private:
  std::mutex mutex_;  // guards the one below
  bool happened_ = false;
  std::condition_variable changed_;
};

}  // namespace weft
