// SPDX-License-Identifier: Apache-2.0
// `weft check`: the independent checker judges a mesh file.
#include "checker/check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "client/base/text.h"
#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/formats/mesh_formats.h"
#include "client/formats/raster.h"

namespace weft::client {
namespace {

check::Domain to_checker(const Domain& domain, double snap) {
  check::Domain out;
  for (const Point& point : domain.points) out.points.push_back({point.x, point.y});
  for (const Domain::Segment& segment : domain.segments) {
    out.segments.push_back({segment.a, segment.b});
    out.markers.push_back(segment.marker);
  }
  for (const Point& hole : domain.holes) out.holes.push_back({hole.x, hole.y});
  for (const Domain::Region& region : domain.regions)
    out.regions.push_back({{region.at.x, region.at.y}, region.id, region.max_area});
  out.fill = domain.fill == Domain::Fill::kEvenOdd ? check::Fill::kEvenOdd : check::Fill::kSeeds;
  out.snap = snap;
  return out;
}

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

check::Raster to_checker(Raster&& raster) {
  return {{raster.x, raster.y}, raster.dx,   raster.dy,
          raster.columns,       raster.rows, std::move(raster.values)};
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
  const auto input = read_input_domain(options.domain, options.size, options.projection);
  if (!input) return tl::unexpected(input.error());
  const auto mesh = read_mesh(options.mesh);
  if (!mesh) return tl::unexpected(mesh.error());
  check::Requirements requirements;
  requirements.min_angle_deg = options.min_angle_deg;
  requirements.allowed_unrefined = options.max_unrefined;
  if (is_raster_path(options.size)) {
    auto raster = read_raster(options.size);
    if (!raster) return tl::unexpected(raster.error());
    requirements.size = to_checker(std::move(*raster));
  } else if (!options.size.empty()) {
    double constant = 0;
    const char* end = options.size.data() + options.size.size();
    const auto [stop, problem] = std::from_chars(options.size.data(), end, constant);
    if (stop == end && problem != std::errc::invalid_argument) {
      // No area exceeds NaN or infinity: the check could not fail.
      if (problem != std::errc() || !(std::isfinite(constant) && constant > 0))
        return fail(ExitCode::kUsage,
                    "--size is " + options.size + "; it must be positive and finite");
      requirements.max_area = constant;
    } else {
      requirements.size = options.size;
    }
  }
  const check::Report report = check::check(to_checker(input->domain, options.snap.value_or(0)),
                                            to_checker(*mesh), requirements);
  const auto printed =
      print(check::to_text(report) + (report.ok() ? "the mesh holds\n" : "the mesh fails\n"));
  if (!printed) return printed;
  return report.ok() ? ExitCode::kOk : ExitCode::kCheckFailed;
}

}  // namespace weft::client
