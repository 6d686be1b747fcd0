// SPDX-License-Identifier: Apache-2.0
// Mesh files: which formats there are, and how each is read and written. docs/formats.md says what
// each carries.
//
//   const MeshFormat* format = mesh_format("key.vtu");
//   write_mesh(*format, mesh, files, {.order = 2});
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/base/atomic_file.h"
#include "client/base/error.h"
#include "client/formats/domain.h"
#include "client/formats/mesh.h"
#include "client/formats/vertex_values.h"

namespace weft::client {

enum class MshVersion { k22, k41 };

// How to write meshes, if their format has a choice.
struct MeshWriteOptions {
  int order = 1;  // 2: six-node triangles, for formats of second order
  MshVersion msh_version = MshVersion::k41;
  std::vector<std::int32_t> open_boundaries{};  // markers, for ADCIRC

  bool operator==(const MeshWriteOptions&) const = default;
};

struct MeshFormat {
  std::string_view extension;  // lower case, ".vtu"
  bool second_order = false;
  // Null if the format is only read, or only written.
  void (*write)(const MeshView&, std::span<OutputFile>, const MeshWriteOptions&) = nullptr;
  Result<Mesh> (*read)(const std::filesystem::path&) = nullptr;
  // Null if the format carries no values at vertices.
  Result<VertexValues> (*read_values)(const std::filesystem::path&,
                                      const std::string& array) = nullptr;
};

// The format of an extension, in upper or lower case; null if there is none.
const MeshFormat* mesh_format(const std::filesystem::path& path);

// ".vtu, .msh, .node, ...": those that are written, and those that are read.
std::string written_mesh_extensions();
std::string read_mesh_extensions();

// "'.stp' is not that of a mesh format that is written: .vtu, .msh, .node, ..." (kUsage).
tl::unexpected<Error> unknown_mesh_format(const std::filesystem::path& path);

// Succeeds if meshes can be written to `path` in this way; otherwise kUsage.
Result<void> check_writable(const std::filesystem::path& path, const MeshWriteOptions& options);

// The files that writing to `path` makes. REQUIRES: the format is known.
std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& path);

// Writes the mesh into `files`, opened for mesh_files(path) in that order. Failures stay in the
// files. REQUIRES: check_writable.
void write_mesh(const MeshFormat& format, const MeshView& mesh, std::span<OutputFile> files,
                const MeshWriteOptions& options = {});

// Reads a mesh. Errors: kUsage for an extension that is unknown or only written, kUnreadableInput
// for the rest. A mesh that was read has vertex numbers in range, finite coordinates and as many
// regions and markers as triangles and edges; nothing else is promised.
Result<Mesh> read_mesh(const std::filesystem::path& path);

// The last check of all readers: ensures the promises of read_mesh.
Result<Mesh> validated(const std::filesystem::path& path, Mesh mesh);

// The extension in lower case.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace weft::client
