// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace weft::server {

// What one client may have of a number of places: rounded down, but one at least, if there is any.
inline std::size_t share_of(std::size_t all, double share) {
  const auto part = static_cast<std::size_t>(static_cast<double>(all) * std::min(share, 1.0));
  return std::max<std::size_t>(part, std::min<std::size_t>(all, 1));
}

}  // namespace weft::server
