// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/feature_properties.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/number_text.h"

namespace weft::files {
namespace {

PropertyValue value_of_property(const Properties& properties, const char* name) {
  PropertyValue value = properties(name);
  const std::string_view text = trimmed(value.text);
  if (const auto number = real_of(text)) value.number = number;
  if (value.number || text.empty()) value.text.clear();
  return value;
}

// What names a marker or region beside its number, or instead of it: `named` is the text of the
// property without "_name".
std::string name_of(GeometryBuilder& builder, const std::string& path, const std::string& named,
                    const PropertyValue& value) {
  const bool is_blank = trimmed(value.text).empty();
  if (value.number)
    builder.leave_out_property(path, shortest(*value.number) + ", not a text");
  else if (!value.other.empty())
    builder.leave_out_property(path, value.other + ", not a text");
  else if (!named.empty() && !is_blank && value.text != named)
    builder.leave_out_property(path,
                               in_quotes(value.text) + " beside the name " + in_quotes(named));
  if (!named.empty()) return named;
  return is_blank ? "" : value.text;
}

Result<std::optional<std::int32_t>> id_of(const GeometryBuilder& builder, const std::string& path,
                                          std::optional<double> value) {
  if (!value) return std::nullopt;
  constexpr double kMax = std::numeric_limits<std::int32_t>::max();
  if (!(*value >= -kMax - 1 && *value <= kMax) || *value != std::nearbyint(*value))
    return builder.bad(path, "is " + shortest(*value) + ", not an integer of 32 bits");
  return static_cast<std::int32_t>(*value);
}

Result<std::optional<double>> bound_of(const GeometryBuilder& builder, const std::string& path,
                                       const PropertyValue& value) {
  if (!value.text.empty())
    return builder.bad(path, "is " + in_quotes(value.text) + ", not a number");
  if (!value.other.empty()) return builder.bad(path, "is " + value.other + ", not a number");
  if (value.number && !(*value.number > 0))
    return builder.bad(path, "is " + shortest(*value.number) + ", not positive");
  return value.number;
}

}  // namespace

PropertyValue number_of_table(const std::string& name, double number) {
  const bool is_null = number == 0 && (name == "max_area" || name == "max_edge");
  return is_null ? PropertyValue{} : PropertyValue{number, "", ""};
}

Result<GeometryProperties> feature_properties(GeometryBuilder& builder, const std::string& place,
                                              const Properties& properties) {
  GeometryProperties out;
  const auto read_id = [&](const std::string& kind,
                           std::string& name) -> Result<std::optional<std::int32_t>> {
    const PropertyValue value = value_of_property(properties, kind.c_str());
    if (!value.other.empty())
      builder.leave_out_property(place + kind, value.other + ", neither a number nor a text");
    const std::string name_property = kind + "_name";
    name = name_of(builder, place + name_property, value.text, properties(name_property.c_str()));
    return id_of(builder, place + kind, value.number);
  };
  const auto marker = read_id("marker", out.marker_name);
  if (!marker) return tl::unexpected(marker.error());
  out.marker = marker->value_or(0);
  const auto region = read_id("region", out.region_name);
  if (!region) return tl::unexpected(region.error());
  out.region = *region;
  for (const auto& [name, bound] :
       {std::pair{"max_area", &out.max_area}, {"max_edge", &out.max_edge}}) {
    const auto value = bound_of(builder, place + name, value_of_property(properties, name));
    if (!value) return tl::unexpected(value.error());
    *bound = *value;
  }
  return out;
}

}  // namespace weft::files
