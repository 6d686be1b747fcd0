// SPDX-License-Identifier: Apache-2.0
// Reads a domain from well-known text (OGC 06-103r4, clause 7): POINT, LINESTRING, LINEARRING,
// POLYGON, TRIANGLE, their MULTI forms and GEOMETRYCOLLECTION, with Z, M or ZM, whose numbers are
// dropped; and those with arcs, CIRCULARSTRING, COMPOUNDCURVE, CURVEPOLYGON, MULTICURVE and
// MULTISURFACE (three_point_arcs.h). A file holds one or several geometries, separated by blanks or
// ';'; "SRID=4326;" before one is ignored. Names are in any case. What is meshed: see
// geometry_builder.h.
//
// Errors (kUnreadableInput) carry file:line:column if the text is wrong, otherwise the line and
// the part ("line 3, geometry 2, ring 1").
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/domains/geometry_builder.h"

namespace weft::files {

Result<Domain> read_wkt(const std::filesystem::path& path, bool lonlat = false);

// Where a text of a file begins: both from 1.
struct TextPlace {
  std::uint64_t line = 1;
  std::size_t column = 1;
};

// Adds the geometries of a text to those of the builder, all with the same properties. `name` is
// that of the file, `place` where the text is in it.
Result<void> add_wkt(const std::string& name, std::string_view text, TextPlace place,
                     const GeometryProperties& properties, GeometryBuilder& builder);

}  // namespace weft::files
