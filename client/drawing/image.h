// SPDX-License-Identifier: Apache-2.0
// Pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "client/base/files.h"
#include "files/base/error.h"

namespace weft::client {

// Pixels as cairo's RGB24: 0x00RRGGBB, rows from the top.
struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint32_t> pixels;
};

// The bytes of a PNG file. Errors: kInternal is cairo's, or there is none.
Result<std::string> png_of(const Image& image);

}  // namespace weft::client
