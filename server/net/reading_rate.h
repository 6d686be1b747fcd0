// SPDX-License-Identifier: Apache-2.0
// How fast a client reads what waits for it, and how slowly it may.
//
//   rate.start(now);                                      // something waits for the client
//   rate.add(bytes);                                      // it has taken so many
//   if (auto slowness = rate.too_slow(now, patience)) ... // a sentence
//   rate.rest();                                          // it has all that there is
//
// Not thread-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace weft::server {

// How slowly a client may read while something waits for it.
struct ReaderPatience {
  // How long it may read nothing.
  std::chrono::steady_clock::duration stall_timeout = std::chrono::seconds(60);
  // Least bytes per second, on average over stall_timeout. 0: any rate.
  std::uint64_t least_rate = 4096;
};

class ReadingRate {
 public:
  using Clock = std::chrono::steady_clock;

  // Without effect while something waits already.
  void start(Clock::time_point now) {
    if (!since_) since_ = now;
  }
  void add(std::uint64_t bytes) { bytes_ += bytes; }
  void rest() {
    since_.reset();
    bytes_ = 0;
  }

  // Once something has always waited for stall_timeout: nullopt, and from now on anew, if the
  // client has read enough since then. Before that, nullopt.
  std::optional<std::string> too_slow(Clock::time_point now, const ReaderPatience& patience);

 private:
  // Since when something has always waited, or the last judgement; and what was taken since then.
  std::optional<Clock::time_point> since_;
  std::uint64_t bytes_ = 0;
};

}  // namespace weft::server
