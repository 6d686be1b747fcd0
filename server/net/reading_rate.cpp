// SPDX-License-Identifier: Apache-2.0
#include "server/net/reading_rate.h"

#include <fmt/format.h>

#include <utility>

namespace weft::server {

std::optional<std::string> ReadingRate::too_slow(Clock::time_point now,
                                                 const ReaderPatience& patience) {
  if (!since_ || now - *since_ < patience.stall_timeout) return std::nullopt;
  const std::uint64_t read = std::exchange(bytes_, 0);
  const double spent = std::chrono::duration<double>(now - *since_).count();
  since_ = now;
  if (static_cast<double>(read) >= spent * static_cast<double>(patience.least_rate))
    return std::nullopt;
  return fmt::format(
      "the client read {} bytes in {:.1f} s; this server's least rate is {} a second", read, spent,
      patience.least_rate);
}

}  // namespace weft::server
