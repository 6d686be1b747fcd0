// SPDX-License-Identifier: Apache-2.0
// Formats of surfaces in space, for viewers and printers; z is 0.
//   .obj  Wavefront: triangles in groups "region_<id>", edges as lines in groups "marker_<value>"
//   .off  Object file format: vertices and triangles; no regions, no edges
//   .ply  Stanford polygons, binary: vertices in double precision, faces with `region`; no edges
//         (some readers refuse them)
//   .stl  binary: triangles in single precision, each on its own; no regions, no edges
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_obj(const MeshView& mesh, OutputFile& file);
void write_off(const MeshView& mesh, OutputFile& file);
void write_ply(const MeshView& mesh, OutputFile& file);
void write_stl(const MeshView& mesh, OutputFile& file);

// Faces must be triangles; z, normals, textures and materials are dropped.
Result<Mesh> read_obj(const std::filesystem::path& path);
Result<Mesh> read_off(const std::filesystem::path& path);

}  // namespace weft::files
