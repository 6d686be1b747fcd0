// SPDX-License-Identifier: Apache-2.0
// Reads a geometry of Netgen in the plane, .in2d: `splinecurves2dv2`, whose sections are called
// points, segments and materials; `splinecurves2dnew` and `splinecurves2d`, which have counts.
//
//   splinecurves2dv2
//   5                        # grading, not read
//   points
//   1  0 0                   # number, x, y
//   segments
//   1 0 2  1 2 -bc=3         # domain on the left, on the right; 2 points, of a line
//   1 0 3  2 3 4 -bcname=in  # 3 points, of a rational curve: the second is where its tangents meet
//   materials
//   1 iron -maxh=0.1         # domain, its name
//
// A domain is an area (Fill::kUnion) whose border are the segments that have it on one side only;
// its number is its region. A segment is its marker's, -bc, a number or a name, or -bcname; else 0.
// Those between two domains are there twice, once for each. A rational curve is that of Netgen,
// which is an arc of a circle if its tangents have one length: a type 4, where it must be; other
// curves are followed by biarcs (spline.h). `discretepoints` are a polyline, `bsplinepoints` the
// control points of a spline of order 2 to 4, which ends at the first and last of them.
//
// Warnings: flags and factors that size or refine otherwise than -maxh of a domain; points that
// belong to nothing. Errors (kUnreadableInput) carry file:line:column: also numbers of points that
// are not there or there twice, a domain whose border is not closed.
#pragma once

#include <filesystem>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

// `lonlat` has no effect.
Result<Domain> read_in2d(const std::filesystem::path& path, bool lonlat = false);

}  // namespace weft::files
