// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/feature_properties.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "client/base/text.h"
#include "client/base/words.h"
#include "client/formats/files/number_text.h"

namespace weft::client {
namespace {

PropertyValue value_of_property(const Properties& properties, const char* name) {
  PropertyValue value = properties(name);
  const std::string_view text = trimmed(value.text);
  if (const auto number = real_of(text)) value.number = number;
  if (value.number || text.empty()) value.text.clear();
  return value;
}

Result<std::optional<std::int32_t>> id_of(const GeometryBuilder& builder, const std::string& path,
                                          std::optional<double> value) {
  if (!value) return std::nullopt;
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  if (!(*value >= -kMost - 1 && *value <= kMost) || *value != std::nearbyint(*value))
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

Result<GeometryProperties> feature_properties(const GeometryBuilder& builder,
                                              const std::string& place,
                                              const Properties& properties) {
  GeometryProperties out;
  const PropertyValue marker = value_of_property(properties, "marker");
  const auto marker_id = id_of(builder, place + "marker", marker.number);
  if (!marker_id) return tl::unexpected(marker_id.error());
  out.marker = marker_id->value_or(0);
  out.marker_name = marker.text.empty() ? properties("marker_name").text : marker.text;
  const PropertyValue region = value_of_property(properties, "region");
  const auto region_id = id_of(builder, place + "region", region.number);
  if (!region_id) return tl::unexpected(region_id.error());
  out.region = *region_id;
  out.region_name = region.text.empty() ? properties("region_name").text : region.text;
  for (const auto& [name, bound] :
       {std::pair{"max_area", &out.max_area}, {"max_edge", &out.max_edge}}) {
    const auto value = bound_of(builder, place + name, value_of_property(properties, name));
    if (!value) return tl::unexpected(value.error());
    *bound = *value;
  }
  return out;
}

}  // namespace weft::client
