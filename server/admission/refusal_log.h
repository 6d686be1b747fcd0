// SPDX-License-Identifier: Apache-2.0
// Lines of the log that a stranger can cause, at most so many a second: those beyond are counted,
// and a line says how many they were.
//
//   RefusalLog refusals(log, "call_refused", 20);
//   if (refusals.take()) log->info("event=call_refused ...");
//   ... a few times a second: refusals.tell_of_rest() ...
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

class RefusalLog {
 public:
  using Clock = std::chrono::steady_clock;

  RefusalLog(Logger log, const char* event, std::uint64_t lines_a_second)
      : log_(std::move(log)), event_(event), most_(lines_a_second) {}

  // Whether the caller may write a line now; if not, it is counted.
  bool take(Clock::time_point now = Clock::now());

  // Writes how many lines were left out in the seconds before this one, if any were.
  void tell_of_rest(Clock::time_point now = Clock::now());

 private:
  void turn(Clock::time_point now);  // REQUIRES: mutex_ is held

  const Logger log_;
  const char* const event_;
  const std::uint64_t most_;
  std::mutex mutex_;  // guards all below
  Clock::time_point second_{};
  std::uint64_t lines_ = 0;     // of this second
  std::uint64_t left_out_ = 0;  // of this second
};

}  // namespace weft::server
