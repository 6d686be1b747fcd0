// SPDX-License-Identifier: Apache-2.0
// Reads a domain from a table of the corners of rings, one to a line:
//
//   x,y,marker        optional: the names of the columns, in any order and case; x and y (or lon
//   and 0,0,1             lat, or longitude and latitude) must be there, ring and marker may be.
//   Without 4,0,2             this line the columns are x and y. 4,4,2 0,4,2             the ring
//   closes by itself; its first corner may be repeated
//                     a line without a corner ends the ring
//   1,1,5
//
// Columns are separated by commas, semicolons, tabs or blanks; '#' starts a comment. Where there is
// a column `ring`, an integer, a ring ends where it changes. `marker`, an integer, is that of the
// segment from this corner to the next. The points inside an odd number of rings are meshed, so a
// ring in a ring is a hole.
//
// Errors (kUnreadableInput) carry file:line:column, or name the ring by the line where it starts.
#pragma once

#include <filesystem>

#include "client/base/error.h"
#include "client/formats/domain.h"

namespace weft::client {

Result<Domain> read_csv_rings(const std::filesystem::path& path);

}  // namespace weft::client
