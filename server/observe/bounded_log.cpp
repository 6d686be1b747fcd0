// SPDX-License-Identifier: Apache-2.0
#include "server/observe/bounded_log.h"

#include <utility>

namespace weft::server {

bool BoundedLog::allow(Clock::time_point now) {
  std::lock_guard lock(mutex_);
  turn(now);
  if (lines_ < max_lines_) return ++lines_, true;
  ++suppressed_;
  return false;
}

void BoundedLog::flush_suppressed(Clock::time_point now) {
  std::lock_guard lock(mutex_);
  turn(now);
}

void BoundedLog::turn(Clock::time_point now) {
  if (now - second_ < std::chrono::seconds(1)) return;
  second_ = now;
  lines_ = 0;
  if (const std::uint64_t count = std::exchange(suppressed_, 0); count != 0)
    log_->info("event=lines_left_out count={} of={}", count, event_);
}

}  // namespace weft::server
