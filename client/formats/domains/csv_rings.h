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
// The first line may name the columns, in any order and case: x and y (or lon and lat, or longitude
// and latitude), and optionally ring and marker. Without it, the columns are x and y. Columns are
// separated by commas, semicolons, tabs or blanks; '#' starts a comment.
//
// A line without a corner ends a ring. If there is a column `ring`, an integer, a ring also ends
// where it changes. A ring is closed automatically; its first corner may be repeated. `marker`, an
// integer or a name of one word, is that of the segment from this corner to the next. The points
// inside an odd number of rings are meshed, so a ring in a ring is a hole.
//
// Errors (kUnreadableInput) carry file:line:column, or name the ring by the line where it starts.
#pragma once

#include <filesystem>

#include "client/base/error.h"
#include "client/formats/domain.h"

namespace weft::client {

Result<Domain> read_csv_rings(const std::filesystem::path& path);

}  // namespace weft::client
