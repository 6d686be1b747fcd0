// SPDX-License-Identifier: Apache-2.0
// Domains in Triangle's .poly file (https://www.cs.cmu.edu/~quake/triangle.poly.html):
// points (in the .node file beside it if the file has 0), segments with markers, holes, and
// regions (x, y, attribute, maximum area). A region's attribute is its id if it is an integer, or
// gets one (region_values.h). As Triangle documents it, a lone value is both the attribute and the
// maximum area, and a maximum area that is 0 or negative means no bound. The faces are meshed by
// Triangle's rule, Fill::kSeeds; seeded.h turns other domains into such.
//
// Errors (kUnreadableInput) carry file:line:column. Geometric faults (crossings,
// seeds outside the domain) are left to the server.
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

Result<Domain> read_triangle_poly(const std::filesystem::path& path);

// Writes a domain. REQUIRES: Fill::kSeeds.
void write_triangle_poly(const Domain& domain, OutputFile& file);

}  // namespace weft::files
