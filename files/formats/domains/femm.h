// SPDX-License-Identifier: Apache-2.0
// Reads the geometry of a model of FEMM: magnetics (.fem), electrostatics (.fee), heat flow (.feh),
// currents (.fec), as versions 3.0 and later write them: lines such as `[NumPoints] = 4` before
// rows of numbers, and `<BdryName> = "outer"` in properties.
//
// Segments and arc segments are those of the domain, by the numbers of their points, from 0; arcs
// are arcs. A boundary property is a marker, by its place in the file, from 1, and its name; a
// block label is a seed, its material a region, in the same way. Those of one name are one. A mesh
// size is the diameter of a circle that is as large as triangles may be. `<No Mesh>` is a hole.
//
// Warnings: a unit of length other than metres, which coordinates keep; periodic boundary
// properties, sizes of segments, and a label that is the default of faces without one, which have
// no effect. Errors (kUnreadableInput) carry file:line:column.
#pragma once

#include <filesystem>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

enum class FemmProblem { kMagnetics, kElectrostatics, kHeatFlow, kCurrents };

Result<Domain> read_femm(const std::filesystem::path& path, FemmProblem problem);

}  // namespace weft::files
