// SPDX-License-Identifier: Apache-2.0
// MFEM's mesh (https://mfem.org/mesh-format-v1.0/): triangles with their region as the attribute,
// edges with their marker as the boundary attribute, all of them at least 1, by label_tags.h. Edges
// inside the domain are there, too, and those of the boundary without a marker count as marker 0.
//
// A mesh without names is "MFEM mesh v1.0", which every MFEM reads; one with names is v1.3, which
// MFEM 4.7 and later read: each name is a set of one attribute.
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_mfem(const MeshView& mesh, OutputFile& file);

// An attribute is the region or the marker; a set names its attributes. Elements that are no
// triangles, and curved or refined meshes, are an error.
Result<Mesh> read_mfem(const std::filesystem::path& path);

}  // namespace weft::files
