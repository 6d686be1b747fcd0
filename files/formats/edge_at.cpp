// SPDX-License-Identifier: Apache-2.0
#include "files/formats/edge_at.h"

#include <cmath>

#include "files/base/text.h"
#include "files/base/value_of.h"

namespace weft::files {

tl::expected<EdgeAt, std::string> EdgeAt::parse(const std::string& text) {
  const std::string start = "marker=";
  const std::size_t colon = text.rfind(':');
  if (text.starts_with(start) && colon != std::string::npos && colon > start.size()) {
    const std::string which = text.substr(start.size(), colon - start.size());
    const auto marker = value_of<std::int32_t>(which);
    const auto max_edge = value_of<double>(text.substr(colon + 1));
    if (!which.empty() && max_edge && std::isfinite(*max_edge) && *max_edge > 0)
      return marker ? EdgeAt{*marker, *max_edge} : EdgeAt{0, *max_edge, which};
  }
  return tl::unexpected(in_quotes(text) +
                        " is not a marker and a positive length, such as marker=2:500");
}

}  // namespace weft::files
