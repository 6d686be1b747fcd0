// SPDX-License-Identifier: Apache-2.0
// The names of markers and regions in Triangle's files, which have no place for them but comments.
// A line is a name if it is, from its first letter on, what --names takes:
//
//   # marker=2:inlet
//   # region=1:porous zone
#pragma once

#include <string_view>

#include "files/base/atomic_file.h"
#include "files/formats/names.h"

namespace weft::files {

void put_names(const Names& names, OutputFile& file);

// Adds the names among the lines of a file. Other comments are none.
void read_names(std::string_view text, NameReader& names);

}  // namespace weft::files
