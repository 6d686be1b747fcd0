// SPDX-License-Identifier: Apache-2.0
// NumPy's archive of arrays (https://numpy.org/doc/stable/reference/generated/numpy.savez.html), as
// numpy.load opens it:
//   points        (vertices, 2)   float64
//   triangles     (triangles, 3)  uint32, rows of `points`
//   regions       (triangles,)    int32
//   edges         (edges, 2)      uint32: the edges on input segments
//   edge_markers  (edges,)        int32
//   edge_bulges   (edges,)        float64, if some are chords of arcs: as domains have them
//   parts         (triangles,)    int32, if the mesh is divided
//   marker_ids    (names,)        int32, and
//   marker_names  (names,)        texts: what these markers are called, if any is
//   region_ids, region_names      the same of regions
//   and values at the vertices, (vertices,) float64, by their names
// Written uncompressed, with 64-bit sizes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_npz(const MeshView& mesh, OutputFile& file);

// Reads archives of numpy.savez and numpy.savez_compressed that hold `points` (of 2 or 3 columns,
// the third is dropped) and `triangles`, and perhaps the others; little-endian, in C order, floats
// of 4 or 8 bytes, integers of 4 or 8 bytes, texts of NumPy's type U.
Result<Mesh> read_npz(const std::filesystem::path& path);

// The same with an array (vertices,) of floats under any other name.
Result<MeshWithArrays> read_npz_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted);

}  // namespace weft::files
