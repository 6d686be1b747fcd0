// SPDX-License-Identifier: Apache-2.0
// `weft remesh`: has a part of a mesh meshed anew.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "client/call/mesh_call.h"
#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/commands/mesh_into.h"
#include "client/report/marker_warnings.h"
#include "client/report/mesh_text.h"
#include "client/report/progress_bar.h"
#include "files/base/text.h"
#include "files/formats/derived/mesh_patch.h"
#include "files/formats/derived/orientation.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/domain_formats.h"
#include "files/message/mesh_spool.h"

namespace weft::client {
namespace {

// The patch as it is sent, and what may not be split.
struct Asked {
  InputDomain input;
  RequestOptions options;
};

Result<Asked> ask_for(const RemeshOptions& options, const MeshPatch& patch) {
  Domain domain = patch.domain;
  if (auto named = set_names(options.request_options.names, domain.names); !named)
    return tl::unexpected(named.error());
  auto input = projected(options.mesh, std::move(domain), options.output.projection,
                         options.request_options.asked.domain().snap());
  if (!input) return tl::unexpected(input.error());
  RequestOptions request = options.request_options;
  auto& keep = request.markers.keep;
  const bool keeps_all = keep && keep->markers.empty() && keep->names.empty();
  if (patch.sides > 0 && !keeps_all) {  // a part that touches nothing has no outline
    if (!keep) keep.emplace();
    keep->markers.push_back(patch.outline);
  }
  auto with = with_size(request, input->domain, input->projection.get());
  if (!with) return tl::unexpected(with.error());
  return Asked{std::move(*input), std::move(*with)};
}

std::function<Point(Point)> place_in_file(const InputDomain& input) {
  const DomainProjection* projection = input.projection.get();
  if (projection == nullptr) return [](Point p) { return p; };
  return [projection](Point p) { return projection->to_lonlat(p); };
}

Result<PatchedMesh> made_anew(const RemeshOptions& options, const Mesh& mesh,
                              const MeshPatch& patch, MeshReport& report,
                              const std::stop_token& stop) {
  const auto asked = ask_for(options, patch);
  if (!asked) return tl::unexpected(asked.error());
  const auto connection = connect_for_mesh(options.calls.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  std::error_code ignored;
  auto spool = MeshSpool::create(std::filesystem::temp_directory_path(ignored));
  if (!spool) return tl::unexpected(spool.error());
  ProgressBar progress(stderr, options.quiet ? ProgressStyle::kNone : progress_style_of(stderr));
  const MeshCallOptions call = shown_call(options.calls, progress, asked->input.projection.get());
  auto made =
      call_generate_mesh(*connection, asked->input.domain, asked->options, call, **spool, stop);
  progress.clear();
  if (!made) return tl::unexpected(made.error());
  report = std::move(*made);
  add_projection(asked->input, report);
  add_warnings(sentences(asked->input.domain.warnings), report);
  add_warnings(asked->options.warnings, report);
  const auto view = (*spool)->view();
  if (!view) return tl::unexpected(view.error());
  return put_back(mesh, patch, *view, place_in_file(asked->input));
}

Result<ExitCode> print_report(const RemeshOptions& options, const MeshReport& report,
                              const MeshPatch& patch, const PatchedMesh& patched,
                              const MeshOutput& output) {
  const auto within =
      static_cast<std::size_t>(std::count(patch.within.begin(), patch.within.end(), true));
  const std::size_t triangles = patched.mesh.triangles.size() / 3;
  std::FILE* const to = options.output.text_stream();
  if (options.json) {
    Json json = summary_json(report.summary);
    json["patch"] = {{"triangles_before", within}, {"outline_edges", patch.sides}};
    json["mesh"] = {{"triangles", triangles}, {"vertices", patched.old_vertex.size()}};
    if (!report.warnings.empty()) json["warnings"] = report.warnings;
    return print(json_line(json), to);
  }
  if (options.quiet) return ExitCode::kOk;
  std::string text = "within an outline of " + with_separators(patch.sides) + " edges, " +
                     with_separators(within) + " triangles became\n" +
                     summary_text(report.summary) + "of a mesh of " + with_separators(triangles) +
                     " triangles, " + with_separators(patched.old_vertex.size()) + " vertices\n" +
                     output.text(report.summary);
  for (const std::string& warning : report.warnings) text += "WARNING: " + harmless(warning) + "\n";
  return print(text, to);
}

}  // namespace

Result<ExitCode> run_remesh(const RemeshOptions& options, std::stop_token stop) {
  if (!is_domain_path(options.within)) return unknown_domain_format(options.within);
  auto output = MeshOutput::open(options.output, options.mesh, stop);
  if (!output) return tl::unexpected(output.error());
  auto read = read_mesh_with_arrays(options.mesh);
  if (!read) return tl::unexpected(read.error());
  Mesh& mesh = read->mesh;
  turn_counter_clockwise(mesh);
  const auto polygon = read_domain(options.within, options.layers);
  if (!polygon) return tl::unexpected(polygon.error());
  const auto patch =
      cut_patch(options.mesh.string(), mesh, triangles_within(mesh.view(), *polygon));
  if (!patch) return tl::unexpected(patch.error());

  MeshReport report;
  const auto patched = made_anew(options, mesh, *patch, report, stop);
  if (!patched) return tl::unexpected(patched.error());
  add_warnings(sentences(mesh.warnings), report);
  std::vector<std::vector<double>> values;
  MeshView view = patched->mesh.view();
  std::vector<VertexValues> arrays;
  values.reserve(read->arrays.size());
  for (const NamedArray& array : read->arrays) {
    if (!array.values) continue;
    values.push_back(patched->carried(mesh, *patch, *array.values));
    arrays.push_back({array.name, values.back()});
  }
  view.vertex_values = arrays;
  if (auto found = output->find_markers(patched->mesh.names.markers, mesh.open_markers); !found)
    return tl::unexpected(found.error());
  if (Drawing* const drawing = output->drawing()) drawing->add(view);
  if (auto written = output->write(view, report.summary); !written)
    return tl::unexpected(written.error());
  add_warnings(output->warnings(), report);
  return print_report(options, report, *patch, *patched, *output);
}

}  // namespace weft::client
