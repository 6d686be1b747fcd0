// SPDX-License-Identifier: Apache-2.0
// How much text a terminal shows.
#pragma once

#include <cstddef>

namespace weft::client {

struct ScreenSize {
  std::size_t columns = 80;
  std::size_t lines = 24;
};

}  // namespace weft::client
