// SPDX-License-Identifier: Apache-2.0
// `weft check`: the independent checker judges a mesh file, by its domain, for a model, or both.
#include "checker/check.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "client/call/mesh_request.h"
#include "client/commands/checker_input.h"
#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/report/check_report.h"
#include "client/report/marker_warnings.h"
#include "client/report/model_report.h"
#include "files/base/text.h"
#include "files/formats/bed.h"
#include "files/formats/derived/deep_boundary.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/domains/to_checker.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {
namespace {

std::vector<check::Mesh::Edge> edges_of(const std::vector<std::uint32_t>& ends,
                                        const std::vector<std::int32_t>& markers) {
  std::vector<check::Mesh::Edge> edges;
  edges.reserve(markers.size());
  for (std::size_t e = 0; e < markers.size(); ++e)
    edges.push_back({ends[2 * e], ends[2 * e + 1], markers[e]});
  return edges;
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
  out.edges = edges_of(mesh.edges, mesh.edge_markers);
  out.bulges = mesh.edge_bulges;
  return out;
}

// The depths of a mesh that has them, or elevations turned; empty: none.
std::vector<double> depths_of(const MeshWithArrays& read) {
  for (const NamedArray& array : read.arrays) {
    if (!Bed::is_bed(array.name) || !array.values) continue;
    std::vector<double> depths = *array.values;
    if (array.name != "depth")
      for (double& depth : depths) depth = -depth;
    return depths;
  }
  return {};
}

// What layers have that are given no region.
std::int32_t own_region(const Domain& domain) {
  std::int32_t highest = 0;
  for (const auto& region : domain.regions) highest = std::max(highest, region.id);
  for (const auto& area : domain.areas) highest = std::max(highest, area.region.value_or(0));
  return highest < INT32_MAX ? highest + 1 : highest;
}

Result<check::Requirements> requirements_of(const CheckOptions& options, const InputDomain& input) {
  check::Requirements requirements;
  requirements.min_angle_deg = options.min_angle_deg;
  requirements.allowed_unrefined = options.max_unrefined;
  requirements.simplify = options.simplify.value_or(0);
  requirements.points_per_circle = options.size.asked.size().points_per_circle();
  auto size = checker_size(options.size, input.domain, input.projection.get());
  if (!size) return tl::unexpected(size.error());
  requirements.size = std::move(*size);
  if (options.size.markers.keep) {
    auto kept = options.size.markers.keep->numbers(input.domain.names.markers);
    if (!kept) return tl::unexpected(kept.error());
    requirements.keep = std::move(*kept);
  }
  for (const MarkerPair& pair : options.size.markers.periodic) {
    const auto sides = pair.numbers(input.domain.names.markers);
    if (!sides) return tl::unexpected(sides.error());
    requirements.periodic.push_back(*sides);
  }
  for (const WallLayers& layers : options.size.markers.layers) {
    const auto marker = layers.number(input.domain.names.markers);
    if (!marker) return tl::unexpected(marker.error());
    requirements.layers.push_back({*marker, layers.first, layers.ratio, layers.rows,
                                   layers.region.value_or(own_region(input.domain))});
  }
  return requirements;
}

// Whether all coordinates may be longitudes and latitudes.
bool fits_the_globe(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2)
    if (std::abs(mesh.coordinates[i]) > 360 || std::abs(mesh.coordinates[i + 1]) > 90) return false;
  return true;
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "weft: WARNING: %s\n", warning.c_str());
}

// What is printed of a mesh.
struct Verdict {
  std::string text;
  Json json = Json::object();
  bool holds = true;
};

Result<void> judge_by_domain(const CheckOptions& options, const check::Mesh& mesh,
                             Verdict& verdict) {
  RequestOptions wanted = options.size;
  wanted.fill = options.fill;
  wanted.asked.mutable_domain()->set_snap(options.snap.value_or(0));
  const auto input = read_input_domain(options.domain, wanted, options.projection, options.layers);
  if (!input) return tl::unexpected(input.error());
  print_warnings(sentences(input->domain.warnings));
  if (options.size.asked.size().cells_across() > 0)
    print_warnings({"--cells-across is not judged: the checker knows no widths"});
  const auto requirements = requirements_of(options, *input);
  if (!requirements) return tl::unexpected(requirements.error());
  const check::Report report =
      check::check(checker_domain(input->domain, options.snap.value_or(0)), mesh, *requirements);
  verdict = {check_text(report, *requirements), check_json(report, *requirements), report.ok()};
  return {};
}

// Adds to the verdict. REQUIRES: options.model.
Result<void> judge_for_model(const CheckOptions& options, const MeshWithArrays& read,
                             check::Mesh mesh, Verdict& verdict) {
  MeshWriteOptions boundaries = options.writing;
  if (auto found =
          find_open_boundaries(boundaries, read.mesh.names.markers, read.mesh.open_markers);
      !found)
    return found;
  print_warnings(open_boundary_warnings(markers_of(read.mesh.view()), boundaries.open_boundaries));
  const std::vector<double> depths = depths_of(read);
  if (!depths.empty() && !options.projection.wanted() && fits_the_globe(read.mesh))
    print_warnings({"coordinates are taken for metres; if they are degrees, add --lonlat"});
  if (boundaries.open_deeper) {
    if (depths.empty())
      return fail(ExitCode::kUsage, "--open-boundary deeper:" + shortest(*boundaries.open_deeper) +
                                        " needs depths: " + options.mesh.string() + " has none");
    MeshView view = read.mesh.view();
    const VertexValues bed{"depth", depths};
    view.vertex_values = {&bed, 1};
    const DeepBoundary deep =
        deep_boundary(view, *boundaries.open_deeper, boundaries.open_boundaries);
    print_warnings(deep_boundary_warnings(deep, *boundaries.open_deeper));
    mesh.edges = edges_of(deep.edges, deep.markers);
    boundaries.open_boundaries.push_back(deep.marker);
  }
  const check::ModelReport report = check::judge_for_models(
      {.mesh = mesh,
       .open_markers = boundaries.open_boundaries,
       .depths = depths,
       .lonlat = options.projection.wanted() && !options.projection.to_metres});
  const ModelView view{*options.model, report, !boundaries.open_boundaries.empty(),
                       !depths.empty()};
  verdict.text += model_text(view);
  verdict.holds &= view.holds();
  verdict.json["for"] = model_json(view);
  verdict.json["holds"] = verdict.holds;
  return {};
}

}  // namespace

Result<ExitCode> run_check(const CheckOptions& options) {
  const bool has_domain = !options.domain.empty();
  if (!has_domain && !options.model)
    return fail(ExitCode::kUsage, "--domain is required, unless --for names a model");
  if (options.snap && !(std::isfinite(*options.snap) && *options.snap >= 0))
    return fail(ExitCode::kUsage,
                "--snap is " + shortest(*options.snap) + "; it must be finite and 0 or more");
  if (options.simplify && !(std::isfinite(*options.simplify) && *options.simplify >= 0))
    return fail(ExitCode::kUsage, "--simplify is " + shortest(*options.simplify) +
                                      "; it must be finite and 0 or more");
  if (has_domain && options.projection.wanted() && !options.projection.to_metres)
    return fail(ExitCode::kUsage,
                "a mesh is checked in the plane that it was made in: write it with --to-metres, "
                "and say --to-metres here, too");
  const auto read = read_mesh_with_arrays(options.mesh);
  if (!read) return tl::unexpected(read.error());
  print_warnings(sentences(read->mesh.warnings));
  check::Mesh mesh = to_checker(read->mesh);
  Verdict verdict;
  if (has_domain)
    if (auto judged = judge_by_domain(options, mesh, verdict); !judged)
      return tl::unexpected(judged.error());
  if (options.model)
    if (auto judged = judge_for_model(options, *read, std::move(mesh), verdict); !judged)
      return tl::unexpected(judged.error());
  const auto printed = print(options.json ? json_line(verdict.json) : verdict.text);
  if (!printed) return printed;
  return verdict.holds ? ExitCode::kOk : ExitCode::kCheckFailed;
}

}  // namespace weft::client
