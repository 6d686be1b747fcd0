// SPDX-License-Identifier: Apache-2.0
#include "client/call/retry.h"

#include <algorithm>
#include <optional>

#include "client/call/server_error.h"
#include "google/rpc/error_details.pb.h"

namespace weft::client {
namespace {

using std::chrono::milliseconds;

// How long the server asks the client to wait; nullopt if it does not ask.
std::optional<milliseconds> wait_asked(const grpc::Status& status) {
  const google::rpc::Status rich = rich_status(status);
  google::rpc::RetryInfo info;
  for (const auto& detail : rich.details()) {
    if (!detail.Is<google::rpc::RetryInfo>() || !detail.UnpackTo(&info)) continue;
    constexpr std::int64_t kHour = 3600;  // a nonsensical value must not overflow
    const auto& delay = info.retry_delay();
    return milliseconds(1000 * std::clamp<std::int64_t>(delay.seconds(), 0, kHour) +
                        std::clamp(delay.nanos(), 0, 999'999'999) / 1'000'000);
  }
  return std::nullopt;
}

}  // namespace

bool Retry::again(const grpc::Status& status) {
  if (status.ok() || failures_ >= options_.attempts) return false;
  const auto asked = wait_asked(status);
  if (!asked && status.error_code() != grpc::StatusCode::UNAVAILABLE) return false;

  constexpr std::uint32_t kMaxDoublings = 20;
  const auto doubled = options_.first_wait * (1 << std::min(failures_, kMaxDoublings));
  const milliseconds about = std::max(
      std::min<milliseconds>(doubled, options_.longest_wait),
      std::clamp(asked.value_or(milliseconds(0)), milliseconds(0), options_.longest_wait_asked));
  std::uniform_real_distribution<double> by_chance(asked ? 1.0 : 0.75, 1.25);
  const auto wait = std::chrono::ceil<milliseconds>(
      std::chrono::duration<double, std::milli>(about) * by_chance(random_));
  if (options_.deadline && std::chrono::system_clock::now() + wait >= *options_.deadline)
    return false;
  if (failures_ == 0 && options_.on_wait) options_.on_wait(status);
  ++failures_;
  return options_.wait(wait);
}

}  // namespace weft::client
