// SPDX-License-Identifier: Apache-2.0
// Reads a domain from Triangle's .poly file (https://www.cs.cmu.edu/~quake/triangle.poly.html):
// points (in the .node file beside it when the file has 0), segments with markers, holes, and
// regions (x, y, attribute, maximum area). A region's attribute is its id and must be an integer;
// a maximum area that is absent, 0 or negative means no bound. The faces are meshed by Triangle's
// rule, Fill::kSeeds.
//
// Errors (kUnreadableInput) carry file:line:column. What only geometry can tell (crossings,
// zero-length segments, seeds outside the domain) is left to the server.
#pragma once

#include <filesystem>

#include "client/error.h"
#include "client/formats/domain.h"

namespace weft::client {

Result<Domain> read_triangle_poly(const std::filesystem::path& path);

}  // namespace weft::client
