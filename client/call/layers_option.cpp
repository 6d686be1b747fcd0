// SPDX-License-Identifier: Apache-2.0
#include "client/call/layers_option.h"

#include <algorithm>
#include <cmath>

#include "client/base/option_row.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

// Sets what "first=1e-5" names; false if it names nothing, or not that kind of number.
bool set(const std::string& text, v1::Layers& rows) {
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  const std::string value = text.substr(std::min(equals + 1, text.size()));
  const auto number = value_of<double>(value);
  const auto count = value_of<std::uint32_t>(value);
  const auto region = value_of<std::int32_t>(value);
  if (name == "first" && number && std::isfinite(*number))
    rows.set_first(*number);
  else if (name == "ratio" && number && std::isfinite(*number))
    rows.set_ratio(*number);
  else if (name == "rows" && count)
    rows.set_rows(*count);
  else if (name == "region" && region)
    rows.set_region(*region);
  else
    return false;
  return true;
}

}  // namespace

tl::expected<LayersOption, std::string> LayersOption::parse(const std::string& text) {
  const auto fault = [&text] {
    return tl::unexpected(in_quotes(text) +
                          " is not a marker and rows, such as wall:first=1e-5,ratio=1.2,rows=20");
  };
  const std::size_t colon = text.find(':');
  if (colon == 0 || colon == std::string::npos) return fault();
  LayersOption option{text.substr(0, colon)};
  for (std::size_t at = colon + 1; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (!set(text.substr(at, comma - at), option.rows)) return fault();
    at = comma + 1;
  }
  if (option.rows.first() == 0 || option.rows.rows() == 0) return fault();
  return option;
}

Result<v1::Layers> LayersOption::message(const NameTable& names_of_markers) const {
  const auto number = value_of<std::int32_t>(marker);
  const auto found = number ? Result<std::int32_t>(*number) : find_marker(marker, names_of_markers);
  if (!found) return tl::unexpected(found.error());
  v1::Layers layers = rows;
  layers.set_marker(*found);
  return layers;
}

}  // namespace weft::client
