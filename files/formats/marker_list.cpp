// SPDX-License-Identifier: Apache-2.0
#include "files/formats/marker_list.h"

#include <algorithm>

#include "files/base/value_of.h"

namespace weft::files {

std::optional<MarkerList> MarkerList::parse(const std::string& text) {
  MarkerList list;
  std::size_t at = 0;
  while (true) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string which = text.substr(at, comma - at);
    if (which.empty()) return std::nullopt;
    if (const auto marker = value_of<std::int32_t>(which))
      list.markers.push_back(*marker);
    else
      list.names.push_back(which);
    if (comma == text.size()) return list;
    at = comma + 1;
  }
}

Result<std::vector<std::int32_t>> MarkerList::numbers(const NameTable& names_of_markers) const {
  std::vector<std::int32_t> all = markers;
  for (const std::string& name : names) {
    const auto marker = find_marker(name, names_of_markers);
    if (!marker) return tl::unexpected(marker.error());
    all.push_back(*marker);
  }
  return all;
}

}  // namespace weft::files
