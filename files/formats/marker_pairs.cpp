// SPDX-License-Identifier: Apache-2.0
#include "files/formats/marker_pairs.h"

#include <algorithm>

#include "files/base/value_of.h"

namespace weft::files {
namespace {

Result<std::int32_t> number_of(const std::string& marker, const NameTable& names) {
  if (const auto number = value_of<std::int32_t>(marker)) return *number;
  return find_marker(marker, names);
}

}  // namespace

Result<std::array<std::int32_t, 2>> MarkerPair::numbers(const NameTable& names_of_markers) const {
  const auto first = number_of(from, names_of_markers);
  if (!first) return tl::unexpected(first.error());
  const auto second = number_of(to, names_of_markers);
  if (!second) return tl::unexpected(second.error());
  return std::array{*first, *second};
}

std::optional<std::vector<MarkerPair>> parse_marker_pairs(const std::string& text) {
  std::vector<MarkerPair> pairs;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string pair = text.substr(at, comma - at);
    const std::size_t colon = pair.find(':');
    if (colon == 0 || colon == std::string::npos || colon + 1 == pair.size() ||
        pair.find(':', colon + 1) != std::string::npos)
      return std::nullopt;
    pairs.push_back({pair.substr(0, colon), pair.substr(colon + 1)});
    at = comma + 1;
  }
  return pairs;
}

}  // namespace weft::files
