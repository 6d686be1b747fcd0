// SPDX-License-Identifier: Apache-2.0
// What a field of a size may be without a file: the distance to the domain's segments, or its
// width.
//
//   auto field = DomainField::parse("distance:marker=2,inlet");  // of "coast=distance:marker=..."
//   if (field && *field) fill(**field, domain.names.markers, *size.add_fields());
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "files/base/error.h"
#include "files/formats/field_raster.h"
#include "files/formats/marker_list.h"
#include "files/formats/names.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::wire {

struct DomainField {
  // The distance to segments with these markers, to all if there are none; else the local width.
  std::optional<files::MarkerList> distance{};

  // nullopt: the kind is none of "distance", "distance:marker=M,M" and "width". The error is a text
  // that says what is wrong.
  static std::optional<tl::expected<DomainField, std::string>> parse(const std::string& kind);
};

// A field of a raster's values.
void fill(const files::FieldRaster& raster, v1::NamedField& out);

// Errors: kUsage for a name that no marker has.
files::Result<void> fill(const DomainField& field, const files::NameTable& markers,
                         v1::NamedField& out);

}  // namespace weft::wire
