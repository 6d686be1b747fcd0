// SPDX-License-Identifier: Apache-2.0
// Mesh files with values at their vertices, such as what a solver found, or the sizes that it asks
// for. docs/formats.md says which formats carry them.
//
//   auto old = read_vertex_values("old.vtu", "h");   // old->values[i] is that of vertex i
//   auto all = read_mesh_with_arrays("old.vtu");     // all->arrays[0].name
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

struct MeshWithValues {
  Mesh mesh;                   // of one triangle at least
  std::vector<double> values;  // one for each vertex: finite, or NaN if it has none
};

// Reads a mesh and the array of that name; if the name is empty, the only one. Errors: kUsage for
// an extension of no format that carries values, kUnreadableInput for the rest; the error for an
// array that is missing lists those that there are.
Result<MeshWithValues> read_vertex_values(const std::filesystem::path& path,
                                          const std::string& array);

struct NamedArray {
  std::string name;
  Result<std::vector<double>> values;  // as in MeshWithValues, or why they cannot be read
};

struct MeshWithArrays {
  Mesh mesh;
  std::vector<NamedArray> arrays;
};

// Reads a mesh, of any format that is read, and all its arrays. Errors: those of read_mesh.
Result<MeshWithArrays> read_mesh_with_arrays(const DataPath& path);

// Succeeds if the path's extension is that of a format that carries values; otherwise kUsage.
Result<void> check_has_vertex_values(const std::filesystem::path& path);

// For the readers: which of the arrays are meant by `wanted`: the one of read_vertex_values, or all
// if it is absent.
Result<std::vector<std::string>> chosen_arrays(const std::filesystem::path& path,
                                               std::vector<std::string> arrays,
                                               const std::optional<std::string>& wanted);

// For readers of formats that have a column for the bed, even if it is unknown: the mesh with that
// array. If all of its values are 0 and it is not `wanted`, it is none.
MeshWithArrays with_bed_column(Mesh mesh, const std::string& name, std::vector<double> values,
                               const std::optional<std::string>& wanted);

// Ensures the promises of MeshWithValues for the array of that name, at the nodes of the mesh's
// file.
Result<std::vector<double>> checked(const std::filesystem::path& path, const std::string& name,
                                    Result<std::vector<double>> values, const Mesh& mesh);

}  // namespace weft::files
