// SPDX-License-Identifier: Apache-2.0
// Unpacks bytes that a file holds in less space, and texts of base64. Thread-safe.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace weft::files {

enum class Packing {
  kDeflate,  // RFC 1951, as in archives
  kZlib,     // RFC 1950
  kLz4,      // a block of LZ4, without a frame
  kLzma      // .xz; needs the library liblzma, which is loaded when it is first used
};

// The `size` bytes that were packed. The error says why not, as in "an array " + error: they are
// damaged, or of another size; or liblzma is missing. Memory: no more than 1,100 times the packed
// bytes (LZ4: 255, .xz: 10,000 times), whatever `size` says.
tl::expected<std::string, std::string> unpacked(Packing packing, std::string_view packed,
                                                std::uint64_t size);

// The bytes of a text in base64. Padding ends a group, and another may follow it; blanks are
// skipped. The error is a text, as above.
tl::expected<std::string, std::string> from_base64(std::string_view text);

}  // namespace weft::files
