// SPDX-License-Identifier: Apache-2.0
// `weft stitch`: joins meshes whose outlines meet vertex by vertex.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "client/commands/commands.h"
#include "client/report/mesh_text.h"
#include "files/base/text.h"
#include "files/formats/derived/orientation.h"
#include "files/formats/derived/stitch.h"
#include "files/formats/derived/vertex_values.h"

namespace weft::client {
namespace {

// What was joined so far, with the values that all of it has.
struct Joined {
  MeshWithArrays all;
  std::size_t common_vertices = 0;
  std::size_t common_edges = 0;
  std::vector<std::string> warnings{};
};

Result<MeshWithArrays> read_part(const DataPath& path) {
  auto read = read_mesh_with_arrays(path);
  if (!read) return read;
  turn_counter_clockwise(read->mesh);
  return read;
}

// The values of both, where both have them under one name.
std::vector<NamedArray> values_of_both(const MeshWithArrays& before, const MeshWithArrays& part,
                                       const StitchedMesh& made) {
  std::vector<NamedArray> both;
  for (const NamedArray& array : before.arrays) {
    const auto same = std::find_if(part.arrays.begin(), part.arrays.end(),
                                   [&](const NamedArray& a) { return a.name == array.name; });
    if (same == part.arrays.end() || !same->values || !array.values) continue;
    std::vector<double> values = *array.values;
    values.resize(made.mesh.coordinates.size() / 2);
    for (std::size_t v = 0; v < made.vertices.size(); ++v)
      if (made.vertices[v] >= array.values->size()) values[made.vertices[v]] = (*same->values)[v];
    both.push_back({array.name, std::move(values)});
  }
  return both;
}

// The names of arrays that only one of them has.
void warn_of_lost_values(const std::vector<NamedArray>& arrays, const std::vector<NamedArray>& both,
                         const std::string& file, std::vector<std::string>& warnings) {
  for (const NamedArray& array : arrays)
    if (std::none_of(both.begin(), both.end(),
                     [&](const NamedArray& a) { return a.name == array.name; }))
      warnings.push_back("values " + in_quotes(array.name) + " are not written: not all of " +
                         file + " have them");
}

Result<void> add(const DataPath& path, const StitchOptions& options, Joined& joined) {
  auto part = read_part(path);
  if (!part) return tl::unexpected(part.error());
  auto made = stitch(joined.all.mesh, part->mesh, options);
  if (!made) return tl::unexpected(made.error());
  std::vector<NamedArray> both = values_of_both(joined.all, *part, *made);
  const std::string files = options.names[0] + " and " + options.names[1];
  warn_of_lost_values(joined.all.arrays, both, files, joined.warnings);
  warn_of_lost_values(part->arrays, both, files, joined.warnings);
  for (const std::string& warning : sentences(part->mesh.warnings))
    joined.warnings.push_back(warning);
  joined.common_vertices += made->common_vertices;
  joined.common_edges += made->common_edges;
  joined.all = {std::move(made->mesh), std::move(both)};
  return {};
}

}  // namespace

Result<ExitCode> run_stitch(const StitchMeshOptions& options, std::stop_token stop) {
  auto output =
      MeshOutput::open({.files = options.files, .has_values = true}, options.meshes[0], stop);
  if (!output) return tl::unexpected(output.error());
  auto first = read_part(options.meshes[0]);
  if (!first) return tl::unexpected(first.error());
  Joined joined{std::move(*first)};
  joined.warnings = sentences(joined.all.mesh.warnings);
  std::string name = options.meshes[0].string();
  for (std::size_t i = 1; i < options.meshes.size(); ++i) {
    const StitchOptions how{options.tolerance, {name, options.meshes[i].string()}};
    if (auto ok = add(options.meshes[i], how, joined); !ok) return tl::unexpected(ok.error());
    name += " with " + options.meshes[i].string();
  }
  MeshView view = joined.all.mesh.view();
  std::vector<VertexValues> values;
  for (const NamedArray& array : joined.all.arrays) values.push_back({array.name, *array.values});
  view.vertex_values = values;
  if (auto found = output->find_markers(joined.all.mesh.names.markers); !found)
    return tl::unexpected(found.error());
  const v1::Summary none;
  if (auto written = output->write(view, none); !written) return tl::unexpected(written.error());
  for (const std::string& warning : output->warnings()) joined.warnings.push_back(warning);
  std::FILE* const to = output->options().text_stream();
  if (options.json)
    return print(json_line({{"triangles", view.triangle_count()},
                            {"vertices", view.vertex_count()},
                            {"common_vertices", joined.common_vertices},
                            {"common_edges", joined.common_edges},
                            {"warnings", joined.warnings}}),
                 to);
  if (options.quiet) return ExitCode::kOk;
  std::string text = with_separators(view.triangle_count()) + " triangles, " +
                     with_separators(view.vertex_count()) + " vertices, joined at " +
                     with_separators(joined.common_vertices) + " vertices and " +
                     with_separators(joined.common_edges) + " edges\n" + output->text(none);
  for (const std::string& warning : joined.warnings) text += "WARNING: " + harmless(warning) + "\n";
  return print(text, to);
}

}  // namespace weft::client
