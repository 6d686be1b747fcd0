// SPDX-License-Identifier: Apache-2.0
#include "files/formats/wall_layers.h"

#include <algorithm>
#include <cmath>

#include "files/base/text.h"
#include "files/base/value_of.h"

namespace weft::files {
namespace {

// Sets what "first=1e-5" names; false if it names nothing, or not that kind of number.
bool set(const std::string& text, WallLayers& layers) {
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  const std::string value = text.substr(std::min(equals + 1, text.size()));
  const auto number = value_of<double>(value);
  const auto count = value_of<std::uint32_t>(value);
  const auto region = value_of<std::int32_t>(value);
  if (name == "first" && number && std::isfinite(*number))
    layers.first = *number;
  else if (name == "ratio" && number && std::isfinite(*number))
    layers.ratio = *number;
  else if (name == "rows" && count)
    layers.rows = *count;
  else if (name == "region" && region)
    layers.region = *region;
  else
    return false;
  return true;
}

}  // namespace

tl::expected<WallLayers, std::string> WallLayers::parse(const std::string& text) {
  const auto fault = [&text] {
    return tl::unexpected(in_quotes(text) +
                          " is not a marker and rows, such as wall:first=1e-5,ratio=1.2,rows=20");
  };
  const std::size_t colon = text.find(':');
  if (colon == 0 || colon == std::string::npos) return fault();
  WallLayers layers{text.substr(0, colon)};
  for (std::size_t at = colon + 1; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (!set(text.substr(at, comma - at), layers)) return fault();
    at = comma + 1;
  }
  if (layers.first == 0 || layers.rows == 0) return fault();
  return layers;
}

Result<std::int32_t> WallLayers::number(const NameTable& names_of_markers) const {
  if (const auto number = value_of<std::int32_t>(marker)) return *number;
  return find_marker(marker, names_of_markers);
}

}  // namespace weft::files
