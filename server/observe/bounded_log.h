// SPDX-License-Identifier: Apache-2.0
// Lines of the log that unauthenticated callers can cause, bounded per second: further ones are
// suppressed, and a line says how many were.
//
//   BoundedLog refusals(log, "call_refused", 20);
//   if (refusals.allow()) log->info("event=call_refused ...");
//   ... a few times a second: refusals.flush_suppressed() ...
//     event=lines_left_out count=41873 of=call_refused
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>

#include "server/observe/log.h"

namespace weft::server {

class BoundedLog {
 public:
  using Clock = std::chrono::steady_clock;

  BoundedLog(Logger log, const char* event, std::uint64_t max_lines_per_second)
      : log_(std::move(log)), event_(event), max_lines_(max_lines_per_second) {}

  // Returns whether the caller may write a line now; if not, counts it as suppressed.
  bool allow(Clock::time_point now = Clock::now());

  // Writes how many lines were suppressed in the seconds before this one, if any were.
  void flush_suppressed(Clock::time_point now = Clock::now());

 private:
  void turn(Clock::time_point now);  // REQUIRES: mutex_ is held

  const Logger log_;
  const char* const event_;
  const std::uint64_t max_lines_;
  std::mutex mutex_;  // guards all below
  Clock::time_point second_{};
  std::uint64_t lines_ = 0;       // of this second
  std::uint64_t suppressed_ = 0;  // of this second
};

}  // namespace weft::server
