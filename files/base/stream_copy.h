// SPDX-License-Identifier: Apache-2.0
// Copies what a pipe, a terminal or a file holds, until a stop is requested.
#pragma once

#include <cstdint>
#include <limits>
#include <stop_token>

namespace weft::files {

// Copies from the position of `from` up to its end. Returns 0, or an errno: ECANCELED if a stop was
// requested, for which it waits for neither side; EFBIG if there are more than `limit` bytes.
int copy_stream(int from, int to, const std::stop_token& stop,
                std::uint64_t limit = std::numeric_limits<std::uint64_t>::max());

}  // namespace weft::files
