// SPDX-License-Identifier: Apache-2.0
// `weft draw`: a mesh file as a picture.
#include <algorithm>
#include <memory>
#include <utility>

#include "client/commands/area_bound.h"
#include "client/commands/commands.h"
#include "client/report/mesh_output.h"
#include "files/base/text.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {
namespace {

// Adds the mesh piece by piece, so that a request to stop is noticed soon.
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

// Colours by the bound if there is one and no other colour is asked for.
Result<DrawOptions> drawing_of(const DrawMeshOptions& options) {
  DrawOptions drawing = options.drawing;
  const RequestOptions& size = options.size;
  const bool has_bound = !size.size.empty() || !size.edge.empty();
  if (has_bound && drawing.color == DrawColor::kAuto) drawing.color = DrawColor::kBound;
  if (has_bound != (drawing.color == DrawColor::kBound))
    return fail(ExitCode::kUsage, has_bound ? "--size and --edge are for --color bound"
                                            : "--color bound needs --size or --edge");
  if (options.lonlat) drawing.unit = DrawnUnit::kDegrees;
  return drawing;
}

}  // namespace

Result<ExitCode> run_draw(const DrawMeshOptions& options, std::stop_token stop) {
  const auto drawing = drawing_of(options);
  if (!drawing) return tl::unexpected(drawing.error());
  MeshOutputOptions wanted{.drawings = options.drawings, .drawing = *drawing};
  const auto bound = std::make_shared<AreaBound>();  // known once the mesh is read
  if (drawing->color == DrawColor::kBound)
    wanted.area_bound = [bound](Point at) { return (*bound)(at); };
  auto output = MeshOutput::open(wanted, options.mesh, stop);
  if (!output) return tl::unexpected(output.error());
  const auto mesh = read_mesh(options.mesh);
  if (!mesh) return tl::unexpected(mesh.error());
  if (wanted.area_bound) {
    const auto make_bound = area_bound(options.size, options.mesh.string(), *mesh);
    if (!make_bound) return tl::unexpected(make_bound.error());
    *bound = (*make_bound)();
  }
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
