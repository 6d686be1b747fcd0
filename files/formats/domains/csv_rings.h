// SPDX-License-Identifier: Apache-2.0
// Reads a domain from a table of the corners of rings, one to a line:
//
//   x,y,marker
//   0,0,1
//   4,0,2
//   4,4,2
//   0,4,2
//
//   1,1,5
//
// Separators, decimal commas, quotation marks and comments: see bytes/delimited_text.h. The first
// line may name the columns, in any order and case: x and y (or lon and lat, longitude and
// latitude, easting and northing), and optionally ring, marker and bulge. Others are ignored with a
// warning. Without it, the first two columns are x and y.
//
// A ring ends at a line without a corner, that is with nothing or NaN in both columns, at a line
// that begins with GMT's '>', at a row of -999 -999 or the like (ring_breaks.h), with a warning,
// and where the column `ring` changes. A ring is closed automatically; its first corner may be
// repeated. `marker`, an integer or a name, is that of the segment from this corner to the next,
// and `bulge`, 0 if the field is empty, makes this segment an arc (Domain::Arc). The points inside
// an odd number of rings are meshed, so a ring in a ring is a hole.
//
// If a column is called WKT (or geometry, geom), each line is a feature with a geometry in
// well-known text, and the other columns are its properties (feature_properties.h).
//
// Errors (kUnreadableInput) carry file:line:column, or name the ring by the line where it starts.
// If commas may be decimal marks as well as separators, the error shows both readings.
#pragma once

#include <filesystem>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

Result<Domain> read_csv_rings(const std::filesystem::path& path, bool lonlat = false);

}  // namespace weft::files
