// SPDX-License-Identifier: Apache-2.0
// Pairs of markers of a domain, numbers or names: "left:right,4:2".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/names.h"

namespace weft::files {

struct MarkerPair {
  std::string from;
  std::string to;

  // Both as numbers. Errors: kUsage for a name that is none of these.
  Result<std::array<std::int32_t, 2>> numbers(const NameTable& names_of_markers) const;
  // "left:right".
  std::string text() const { return from + ':' + to; }
};

// nullopt: one of them is no pair, or a marker is empty. Markers whose names have a comma or a
// colon are given by number.
std::optional<std::vector<MarkerPair>> parse_marker_pairs(const std::string& text);

}  // namespace weft::files
