// SPDX-License-Identifier: Apache-2.0
// When a call over a connection is made again (retry.h), and how the waits between are spent: gRPC
// looks after the channel meanwhile, because a connection comes back only while someone waits for
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "client/call/connection.h"
#include "client/call/retry.h"

namespace weft::client {

struct ConnectionRetryOptions {
  std::uint32_t attempts =
      RetryOptions{}.attempts;         // a private server, which does not come back: 0
  std::optional<Deadline> deadline{};  // of all attempts together
  // Told of the first of several failures in a row. DEFAULT: a line on stderr.
  std::function<void(const std::string&)> on_away{};
};

// The deadline of a command with such a time-out, from now on.
std::optional<Deadline> deadline_after(std::optional<double> timeout_seconds);

// The connection outlives what is returned. A stop that is asked for ends a wait.
Retry retry_on(const Connection& connection, ConnectionRetryOptions options, std::stop_token stop);

}  // namespace weft::client
