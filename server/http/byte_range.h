// SPDX-License-Identifier: Apache-2.0
// A part of a file, as `Range` asks for it (RFC 9110): "bytes=500-" is what is left of a download.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace weft::server {

struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t bytes = 0;
};

// Of a file of `size` bytes: all of it unless the header asks for one range; nullopt if nothing of
// that range is there.
std::optional<ByteRange> range_of(std::string_view header, std::uint64_t size);

}  // namespace weft::server
