// SPDX-License-Identifier: Apache-2.0
#include "client/call/connection_retry.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "client/call/server_error.h"

namespace weft::client {
namespace {

// False if a stop was asked for.
bool wait(grpc::Channel& channel, std::chrono::milliseconds time, const std::stop_token& stop) {
  constexpr auto kBetweenLooks = std::chrono::milliseconds(50);
  const auto end = std::chrono::system_clock::now() + time;
  for (auto now = std::chrono::system_clock::now(); now < end && !stop.stop_requested();
       now = std::chrono::system_clock::now())
    channel.WaitForStateChange(channel.GetState(true),
                               std::min<Deadline>(end, now + kBetweenLooks));
  return !stop.stop_requested();
}

void print_line(const std::string& what) {
  std::fprintf(stderr, "weft: %s\n", what.c_str());
}

}  // namespace

std::optional<Deadline> deadline_after(std::optional<double> timeout_seconds) {
  if (!timeout_seconds) return std::nullopt;
  return std::chrono::system_clock::now() + std::chrono::duration_cast<Deadline::duration>(
                                                std::chrono::duration<double>(*timeout_seconds));
}

Retry retry_on(const Connection& connection, ConnectionRetryOptions options, std::stop_token stop) {
  if (!options.on_away) options.on_away = print_line;
  return Retry(
      {.attempts = connection.server ? 0 : options.attempts,
       .deadline = options.deadline,
       .wait =
           [&connection, stop = std::move(stop)](std::chrono::milliseconds time) {
             return wait(*connection.channel, time, stop);
           },
       .on_wait =
           [&connection, on_away = std::move(options.on_away)](const grpc::Status& status) {
             on_away("the server " + connection.address + " answers " +
                     reason_of(rich_status(status)) + ", trying again");
           }});
}

}  // namespace weft::client
