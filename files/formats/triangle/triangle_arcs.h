// SPDX-License-Identifier: Apache-2.0
// The arcs in Triangle's .poly files, which have no place for them but comments. A line that begins
// so makes the segment of that number an arc with that bulge (arc_bulges in the protocol):
//
//   # arc=4:0.41421356237309503
//
// Other programs read a straight segment.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

// Segments are numbered from 1.
void put_arcs(const std::vector<Domain::Arc>& arcs, OutputFile& file);

// `numbers` are those of the segments, in their order. Error: a line names no segment, or one
// twice, or is no number.
Result<std::vector<Domain::Arc>> read_arcs(const std::string& name, std::string_view text,
                                           const std::vector<std::int64_t>& numbers);

}  // namespace weft::files
