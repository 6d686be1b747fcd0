// SPDX-License-Identifier: Apache-2.0
#include "wire/domain_field.h"

#include <string_view>
#include <utility>

#include "files/base/text.h"

namespace weft::wire {

std::optional<tl::expected<DomainField, std::string>> DomainField::parse(const std::string& kind) {
  constexpr std::string_view kMarkers = "distance:marker=";
  if (kind == "width") return DomainField{};
  if (kind == "distance") return DomainField{files::MarkerList{}};
  if (!kind.starts_with(kMarkers)) return std::nullopt;
  auto markers = files::MarkerList::parse(kind.substr(kMarkers.size()));
  if (!markers)
    return tl::unexpected(files::in_quotes(kind) + " does not list markers, such as marker=2,3");
  return DomainField{std::move(*markers)};
}

void fill(const files::FieldRaster& raster, v1::NamedField& out) {
  v1::FieldRaster& to = *out.mutable_raster();
  to.set_x(raster.x);
  to.set_y(raster.y);
  to.set_dx(raster.dx);
  to.set_dy(raster.dy);
  to.set_columns(raster.columns);
  to.set_rows(raster.rows);
  to.mutable_values()->Add(raster.values.begin(), raster.values.end());
}

files::Result<void> fill(const DomainField& field, const files::NameTable& markers,
                         v1::NamedField& out) {
  if (!field.distance) {
    out.mutable_width();
    return {};
  }
  const auto numbers = field.distance->numbers(markers);
  if (!numbers) return tl::unexpected(numbers.error());
  out.mutable_distance()->mutable_markers()->Add(numbers->begin(), numbers->end());
  return {};
}

}  // namespace weft::wire
