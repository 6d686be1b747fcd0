// SPDX-License-Identifier: Apache-2.0
// Frames of HTTP/2, made by hand.
#pragma once

#include <string>
#include <string_view>

#include "server/front/frames.h"

namespace weft::server::testing {

inline std::string frame_bytes(FrameType type, std::uint8_t flags, std::uint32_t stream,
                               std::string_view payload) {
  std::string bytes;
  const auto add = [&bytes](std::size_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bytes += static_cast<char>(value >> (8 * i));
  };
  add(payload.size(), 3);
  bytes += static_cast<char>(type);
  bytes += static_cast<char>(flags);
  add(stream, 4);
  return bytes.append(payload);
}

}  // namespace weft::server::testing
