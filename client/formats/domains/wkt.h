// SPDX-License-Identifier: Apache-2.0
// Reads a domain from well-known text (OGC 06-103r4, clause 7): POINT, LINESTRING, LINEARRING,
// POLYGON, TRIANGLE, their MULTI forms and GEOMETRYCOLLECTION, with Z, M or ZM, whose numbers are
// dropped. A file holds one or several geometries, separated by blanks or ';'; "SRID=4326;" before
// one is ignored. Names are in any case. What is meshed: see geometry_builder.h.
//
// Errors (kUnreadableInput) carry file:line:column if the text is wrong, otherwise the line and
// the part ("line 3, geometry 2, ring 1").
#pragma once

#include <filesystem>

#include "client/base/error.h"
#include "client/formats/domain.h"

namespace weft::client {

Result<Domain> read_wkt(const std::filesystem::path& path);

}  // namespace weft::client
