// SPDX-License-Identifier: Apache-2.0
// Mesh files: which formats there are, and how each is read and written.
//
//   .vtu   VTK unstructured grid, binary appended (vtu.h)
//   .msh   Gmsh 4.1, binary (msh.h)
//   .node  Triangle's .node, .ele and .poly, all three (triangle_mesh.h)
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "client/atomic_file.h"
#include "client/error.h"
#include "client/formats/domain.h"
#include "client/formats/mesh.h"

namespace weft::client {

enum class MeshFormat { kVtu, kMsh, kTriangle };

// By extension, in any case: .vtu, .msh, .node (reading: .ele, too).
std::optional<MeshFormat> mesh_format(const std::filesystem::path& path);

// "'.stl' is not that of a mesh format: .vtu, .msh, .node" (kUsage).
tl::unexpected<Error> unknown_mesh_format(const std::filesystem::path& path);

// The files that writing to `path` makes. REQUIRES: the format is known.
std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& path);

// Writes the mesh into `files`, opened for mesh_files(path) in that order. Failures stay in the
// files.
void write_mesh(MeshFormat format, const MeshView& mesh, std::span<OutputFile> files);

// Reads a mesh. Errors: kUsage for an unknown extension, kUnreadableInput for the rest. A mesh that
// was read has vertex numbers in range, finite coordinates and as many regions and markers as
// triangles and edges; nothing else is promised.
Result<Mesh> read_mesh(const std::filesystem::path& path);

// Reads a domain: .poly, .geojson, .json. Errors as above.
Result<Domain> read_domain(const std::filesystem::path& path);

// Whether the extension is that of a domain.
bool is_domain_path(const std::filesystem::path& path);

// "'.shp' is not that of a domain: .poly, .geojson, .json" (kUsage).
tl::unexpected<Error> unknown_domain_format(const std::filesystem::path& path);

// The common last check of readers: the promises of read_mesh.
Result<Mesh> validated(const std::filesystem::path& path, Mesh mesh);

}  // namespace weft::client
