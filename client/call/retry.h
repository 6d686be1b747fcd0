// SPDX-License-Identifier: Apache-2.0
// Decides when a call is repeated: if the server was away (UNAVAILABLE), or if it says that the
// same call may succeed later (RetryInfo), as it does if its queue is full. Each wait is twice as
// long as the one before, as long as nothing new arrives, and at least as long as the server asks
// for; it varies randomly by a quarter, so that the clients of a restarted server do not all come
// at once.
//
//   Retry retry({.wait = wait});
//   grpc::Status status;
//   do status = call(); while (retry.again(status));
//
// Not thread-safe.
#pragma once

#include <grpcpp/support/status.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <utility>

namespace weft::client {

using Deadline = std::chrono::system_clock::time_point;

struct RetryOptions {
  std::uint32_t attempts = 8;  // after the first, in a row, that bring nothing new
  std::chrono::milliseconds first_wait{100};
  std::chrono::milliseconds longest_wait{5'000};
  std::chrono::milliseconds longest_wait_asked{60'000};  // a server may not ask for more
  std::optional<Deadline> deadline{};                    // of all attempts together
  // Waits so long; returns false if a requested stop ended the wait.
  std::function<bool(std::chrono::milliseconds)> wait;
  // Called before the first of several waits in a row, with the status of the call; may be empty.
  std::function<void(const grpc::Status&)> on_wait{};
};

class Retry {
 public:
  explicit Retry(RetryOptions options) : options_(std::move(options)) {}

  // Call after a call ended with this status. Returns true after waiting if another attempt is due;
  // false if the status is final, the attempts or the time are used up, or a stop ended the wait.
  bool again(const grpc::Status& status);
  // Call when a call brought something: the attempts count from 0 again.
  void restart() { failures_ = 0; }

 private:
  const RetryOptions options_;
  std::uint32_t failures_ = 0;  // in a row
  std::minstd_rand random_{std::random_device{}()};
};

}  // namespace weft::client
