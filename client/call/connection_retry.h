// SPDX-License-Identifier: Apache-2.0
// Repeats calls over a connection (retry.h). Between attempts it waits for the channel, because
// gRPC reconnects only while someone waits for it.
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
  // Called with the first of several failures in a row. DEFAULT: a line on stderr.
  std::function<void(const std::string&)> on_away{};
};

// The deadline of a command with this time-out, counted from now.
std::optional<Deadline> deadline_after(std::optional<double> timeout_seconds);

// The connection must outlive the result. A requested stop ends a wait.
Retry retry_on(const Connection& connection, ConnectionRetryOptions options, std::stop_token stop);

}  // namespace weft::client
