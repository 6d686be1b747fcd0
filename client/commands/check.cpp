// SPDX-License-Identifier: Apache-2.0
// `weft check`: the independent checker judges a mesh file.
#include "checker/check.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "client/base/text.h"
#include "client/call/mesh_request.h"
#include "client/commands/checker_input.h"
#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/formats/domains/to_checker.h"
#include "client/formats/mesh_formats.h"
#include "client/report/check_report.h"

namespace weft::client {
namespace {

check::Mesh to_checker(const Mesh& mesh) {
  check::Mesh out;
  out.vertices.reserve(mesh.coordinates.size() / 2);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2)
    out.vertices.push_back({mesh.coordinates[i], mesh.coordinates[i + 1]});
  out.triangles.reserve(mesh.triangles.size() / 3);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    out.triangles.push_back({mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  out.regions = mesh.regions;
  for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e)
    out.edges.push_back({mesh.edges[2 * e], mesh.edges[2 * e + 1], mesh.edge_markers[e]});
  return out;
}

}  // namespace

Result<ExitCode> run_check(const CheckOptions& options) {
  if (options.snap && !(std::isfinite(*options.snap) && *options.snap >= 0))
    return fail(ExitCode::kUsage,
                "--snap is " + shortest(*options.snap) + "; it must be finite and 0 or more");
  if (options.projection.wanted() && !options.projection.to_metres)
    return fail(ExitCode::kUsage,
                "a mesh is checked in the plane that it was made in: write it with --to-metres, "
                "and say --to-metres here, too");
  RequestOptions wanted = options.size;
  wanted.fill = options.fill;
  const auto input = read_input_domain(options.domain, wanted, options.projection, options.layers);
  if (!input) return tl::unexpected(input.error());
  const auto mesh = read_mesh(options.mesh);
  if (!mesh) return tl::unexpected(mesh.error());
  for (const auto* warnings : {&input->domain.warnings, &mesh->warnings})
    for (const std::string& warning : *warnings)
      std::fprintf(stderr, "weft: WARNING: %s\n", warning.c_str());
  if (options.size.cells_across)
    std::fprintf(stderr,
                 "weft: WARNING: --cells-across is not judged: the checker knows no widths\n");
  check::Requirements requirements;
  requirements.min_angle_deg = options.min_angle_deg;
  requirements.allowed_unrefined = options.max_unrefined;
  auto size = checker_size(options.size, input->domain, input->projection.get());
  if (!size) return tl::unexpected(size.error());
  requirements.size = std::move(*size);
  const check::Report report = check::check(checker_domain(input->domain, options.snap.value_or(0)),
                                            to_checker(*mesh), requirements);
  const auto printed = print(options.json ? json_line(check_json(report, requirements))
                                          : check_text(report, requirements));
  if (!printed) return printed;
  return report.ok() ? ExitCode::kOk : ExitCode::kCheckFailed;
}

}  // namespace weft::client
