// SPDX-License-Identifier: Apache-2.0
// Mesh files: which formats there are, and how each is read and written. docs/formats.md says what
// each carries.
//
//   const MeshFormat* format = mesh_format("key.vtu");
//   write_mesh(*format, mesh, files, {.order = 2});
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/base/data_path.h"
#include "files/base/error.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/domain.h"
#include "files/formats/mesh.h"
#include "files/formats/names.h"
#include "files/formats/nodal_option.h"

namespace weft::files {

enum class MshVersion { k22, k41 };
enum class Renumbering { kNone, kReverseCuthillMcKee };

// How meshes are written, if their format has a choice.
struct MeshWriteOptions {
  int order = 1;  // 2: six-node triangles, for formats of second order
  MshVersion msh_version = MshVersion::k41;
  std::vector<std::int32_t> open_boundaries{};     // markers, for ADCIRC
  std::vector<std::string> open_boundary_names{};  // more of them, by name; writers ignore these
  std::optional<double> open_deeper{};  // what is deeper is open, too (deep_boundary.h); the same
  std::vector<NodalOption> nodal{};     // values at the vertices
  Renumbering renumbering = Renumbering::kNone;  // of the vertices
  std::optional<std::uint32_t> parts{};          // to divide the triangles into
  // Sides that repeat each other, by markers; .msh has their nodes in pairs.
  std::vector<std::array<std::int32_t, 2>> periodic{};

  bool opens_boundaries() const {
    return !open_boundaries.empty() || !open_boundary_names.empty() || open_deeper;
  }
  bool operator==(const MeshWriteOptions&) const = default;
};

// Adds the markers of `open_boundary_names` to `open_boundaries`; if the options open nothing,
// those that the file of the mesh calls open. Error (kUsage): no marker has one of the names.
Result<void> find_open_boundaries(MeshWriteOptions& options, const NameTable& markers,
                                  std::span<const std::int32_t> open_in_file = {});

// Which values at vertices a format carries: none, the bed (bed.h), or all.
enum class CarriesValues { kNone, kBed, kAll };

struct MeshFormat {
  std::string_view extension;  // lower case, ".vtu"
  // The files that a mesh at a path is written to, itself among them; null: itself alone.
  std::vector<std::filesystem::path> (*files)(const std::filesystem::path&) = nullptr;
  bool needs_name = false;  // to be read: there are files beside it, or a library asks for the name
  bool second_order = false;
  // Null if the format is only read, or only written.
  void (*write)(const MeshView&, std::span<OutputFile>, const MeshWriteOptions&) = nullptr;
  Result<Mesh> (*read)(const std::filesystem::path&) = nullptr;
  // Null if the format carries no values at vertices.
  Result<MeshWithArrays> (*read_values)(const std::filesystem::path&,
                                        const std::optional<std::string>& wanted) = nullptr;
  CarriesValues values = CarriesValues::kNone;
  bool parts = false;  // whether it carries the parts of the triangles
  // How it writes the names of markers and regions; null if it does not carry them.
  Spelling marker_names = nullptr;
  Spelling region_names = nullptr;
  NameCase name_case = NameCase::kMatters;
  bool boundary_only = false;    // whether it has the edges of the boundary alone
  bool open_boundaries = false;  // whether it tells open boundaries from land
};

// The format of an extension, in upper or lower case; null if there is none.
const MeshFormat* mesh_format(const DataPath& path);

// ".vtu, .msh, .node, ...": those that are written, and those that are read.
std::string written_mesh_extensions();
std::string read_mesh_extensions();

// "'.stp' is not that of a mesh format that is written: .vtu, .msh, .node, ..." (kUsage).
tl::unexpected<Error> unknown_mesh_format(const DataPath& path);

// Succeeds if meshes can be written to `path` in this way; otherwise kUsage.
Result<void> check_writable(const DataPath& path, const MeshWriteOptions& options);

// What of a mesh with these values, parts and names is not in a file at `path`, or is spelled in
// another way, because of its format: sentences for the user, which name the file. REQUIRES: the
// format is known.
std::vector<std::string> not_carried(const DataPath& path, const MeshView& mesh);

// The files that writing to `path` makes. REQUIRES: the format is known.
std::vector<std::filesystem::path> mesh_files(const DataPath& path);

// Writes the mesh into `files`, opened for mesh_files(path) in that order. Failures stay in the
// files. Returns how many sides on arcs are straight in a mesh of second order, see second_order.h.
// REQUIRES: check_writable.
std::size_t write_mesh(const MeshFormat& format, const MeshView& mesh, std::span<OutputFile> files,
                       const MeshWriteOptions& options = {});

// Reads a mesh. Errors: kUsage for an extension that is unknown or only written, kUnreadableInput
// for the rest. A mesh that was read has vertex numbers in range, finite coordinates, as many
// regions and markers as triangles and edges, and no parts or one from 0 for each triangle; nothing
// else is promised.
Result<Mesh> read_mesh(const DataPath& path);

// The last check of all readers: ensures the promises of read_mesh, and cuts faces into triangles.
Result<Mesh> validated(const std::filesystem::path& path, Mesh mesh);

}  // namespace weft::files
