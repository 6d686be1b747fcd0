// SPDX-License-Identifier: Apache-2.0
// Layers of triangles along a wall: one --layers, such as wall:first=1e-5,ratio=1.2,rows=20.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "files/base/error.h"
#include "files/formats/names.h"

namespace weft::files {

struct WallLayers {
  std::string marker;  // a number or a name
  double first = 0;    // height of the row at the wall
  double ratio = 1;    // of the heights of each row and the one before
  std::uint32_t rows = 0;
  std::optional<std::int32_t> region{};  // of their triangles

  // The error is a text that says what is wrong. A marker whose name has a colon is given by
  // number.
  static tl::expected<WallLayers, std::string> parse(const std::string& text);

  // The marker. Errors: kUsage for a name that is none of these.
  Result<std::int32_t> number(const NameTable& names_of_markers) const;
};

}  // namespace weft::files
