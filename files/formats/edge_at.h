// SPDX-License-Identifier: Apache-2.0
// How long edges may be on segments with a marker: one --edge-at.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

namespace weft::files {

struct EdgeAt {
  std::int32_t marker = 0;
  double max_edge = 0;
  std::string name{};  // of the marker; empty: it is given by number

  // `text` is marker=2:500 or marker=inlet:500. The error is a text that says what is wrong.
  static tl::expected<EdgeAt, std::string> parse(const std::string& text);
};

}  // namespace weft::files
