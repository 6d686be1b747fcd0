// SPDX-License-Identifier: Apache-2.0
// When a call is made again: where the server was away (UNAVAILABLE), and where it says itself that
// the same call may succeed later (RetryInfo), as it does when its queue is full. Each wait is
// twice as long as the one before, as long as nothing new comes, and at least as long as the server
// asks for; a quarter more or less by chance, so that not all clients of a server that starts again
// come at the same moment.
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
  std::uint32_t attempts = 8;  // on top of the first, one after the other, that bring nothing new
  std::chrono::milliseconds first_wait{100};
  std::chrono::milliseconds longest_wait{5'000};
  std::chrono::milliseconds longest_wait_asked{60'000};  // a server may not ask for more
  std::optional<Deadline> deadline{};                    // of all attempts together
  // Waits so long; false if that was cut short, for the user wants to stop.
  std::function<bool(std::chrono::milliseconds)> wait;
  // Called before the first of several waits in a row, with what the call ended with; may be empty.
  std::function<void(const grpc::Status&)> on_wait{};
};

class Retry {
 public:
  explicit Retry(RetryOptions options) : options_(std::move(options)) {}

  // After a call ended with this status. True: another attempt is due, its wait is over. False:
  // that was the last one, for its status is final, the attempts or the time are used up, or the
  // wait was cut short.
  bool again(const grpc::Status& status);
  // A call brought something: the attempts count from 0 again.
  void restart() { failures_ = 0; }

 private:
  const RetryOptions options_;
  std::uint32_t failures_ = 0;  // in a row
  std::minstd_rand random_{std::random_device{}()};
};

}  // namespace weft::client
