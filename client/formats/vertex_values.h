// SPDX-License-Identifier: Apache-2.0
// Mesh files with values at their vertices, such as what a solver found, or the sizes that it asks
// for. docs/formats.md says which formats carry them.
//
//   auto old = read_vertex_values("old.vtu", "h");   // old->values[i] is that of vertex i
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "client/base/error.h"
#include "client/formats/mesh.h"

namespace weft::client {

struct VertexValues {
  Mesh mesh;                   // of one triangle at least
  std::vector<double> values;  // one for each vertex: finite, or NaN if it has none
};

// Reads a mesh and the array of that name; if the name is empty, the only one. Errors: kUsage for
// an extension of no format that carries values, kUnreadableInput for the rest; the error for an
// array that is missing lists those that there are.
Result<VertexValues> read_vertex_values(const std::filesystem::path& path,
                                        const std::string& array);

// Succeeds if the path's extension is that of a format that carries values; otherwise kUsage.
Result<void> check_has_vertex_values(const std::filesystem::path& path);

// For the readers: which of the arrays is meant by `wanted`, see read_vertex_values.
Result<std::string> chosen_array(const std::filesystem::path& path,
                                 const std::vector<std::string>& arrays, const std::string& wanted);

// For the readers: ensures the promises of VertexValues.
Result<VertexValues> validated(const std::filesystem::path& path, const std::string& array,
                               Mesh mesh, std::vector<double> values);

}  // namespace weft::client
