// SPDX-License-Identifier: Apache-2.0
// `weft draw`: a mesh file as a picture.
#include <algorithm>
#include <utility>

#include "client/base/text.h"
#include "client/commands/commands.h"
#include "client/formats/mesh_formats.h"
#include "client/report/mesh_output.h"

namespace weft::client {
namespace {

// Adds the mesh piece by piece, so that a request to stop is soon heard.
Result<void> add_all(const MeshView& mesh, Drawing& drawing, const std::stop_token& stop) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  for (std::size_t first = 0; first == 0 || first < mesh.triangle_count(); first += kPiece) {
    if (stop.stop_requested()) return fail(ExitCode::kUnwritableOutput, "interrupted");
    const std::size_t count = std::min(kPiece, mesh.triangle_count() - first);
    MeshView piece = mesh;
    piece.triangles = mesh.triangles.subspan(3 * first, 3 * count);
    piece.regions = mesh.regions.subspan(first, count);
    if (first > 0) piece.edges = {};
    drawing.add(piece);
  }
  return {};
}

}  // namespace

Result<ExitCode> run_draw(const DrawMeshOptions& options, std::stop_token stop) {
  MeshOutputOptions wanted{.drawings = options.drawings, .drawing = options.drawing};
  if (options.lonlat) wanted.drawing.unit = DrawnUnit::kDegrees;
  auto output = MeshOutput::open(wanted, options.mesh, stop);
  if (!output) return tl::unexpected(output.error());
  const auto mesh = read_mesh(options.mesh);
  if (!mesh) return tl::unexpected(mesh.error());
  if (auto added = add_all(mesh->view(), *output->drawing(), stop); !added)
    return tl::unexpected(added.error());
  if (options.drawing.zoom && output->drawing()->triangles() == 0)
    return fail(ExitCode::kUsage, options.mesh.string() + ": nothing of the mesh is in --zoom");
  const v1::Summary none;
  if (auto written = output->write(mesh->view(), none); !written)
    return tl::unexpected(written.error());
  if (options.quiet) return ExitCode::kOk;
  return print(with_separators(mesh->view().triangle_count()) + " triangles, " +
               with_separators(mesh->view().vertex_count()) + " vertices\n" + output->text(none));
}

}  // namespace weft::client
