// SPDX-License-Identifier: Apache-2.0
// `weft convert`: a mesh into another format, or a domain into a .poly file or the message that a
// request carries.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/call/mesh_request.h"
#include "client/commands/commands.h"
#include "client/report/json_line.h"
#include "client/report/marker_warnings.h"
#include "files/base/text.h"
#include "files/formats/derived/orientation.h"
#include "files/formats/domain_formats.h"
#include "files/formats/domains/seeded.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/standard_streams.h"
#include "files/formats/triangle/triangle_poly.h"

namespace weft::client {
namespace {

constexpr const char* kMessage = ".pb";  // weft.v1.Domain

bool is_mesh_input(const DataPath& path) {
  return is_domain_path(path) && !is_plain_domain_path(path);
}

bool is_mesh_output(const DataPath& path) {
  const MeshFormat* format = mesh_format(path);
  return format != nullptr && format->write != nullptr;
}

std::string warnings_text(const std::vector<Warning>& warnings) {
  std::string text;
  for (const std::string& sentence : sentences(warnings)) text += "WARNING: " + sentence + "\n";
  return text;
}

Json warnings_json(const std::vector<Warning>& warnings) {
  Json all = Json::array();
  for (const Warning& warning : warnings) {
    Json& json = all.emplace_back(Json{{"kind", warning_name(warning.kind)}});
    if (!warning.file.empty()) json["file"] = warning.file;
    if (warning.line > 0) json["line"] = warning.line;
    if (!warning.place.empty()) json["place"] = warning.place;
    json["count"] = warning.count;
    json["sentence"] = warning.sentence();
  }
  return all;
}

void add(WarningKind kind, const std::vector<std::string>& texts, std::vector<Warning>& warnings) {
  for (const std::string& text : texts) warnings.push_back({.kind = kind, .text = text});
}

// Why the array is not written; empty if it is. Only one of depth and elevation is written, so the
// names of `before` and those that --nodal gives count.
std::string excluded(const NamedArray& array, const std::vector<NodalOption>& before) {
  if (!array.values) return array.values.error().message;
  if (auto fault = nodal_name_fault(array.name, before); !fault.empty()) return fault;
  const auto missing = std::find_if(array.values->begin(), array.values->end(),
                                    [](double value) { return std::isnan(value); });
  if (missing == array.values->end()) return "";
  return in_quotes(array.name) + " has no value at vertex " +
         std::to_string(missing - array.values->begin());
}

struct CarriedValues {
  std::vector<VertexValues> values;   // of the arrays
  std::vector<std::string> warnings;  // on the arrays that are not among them
};

// The values of the file that are written: those that --nodal does not replace, unless they cannot
// be read.
CarriedValues carried(const std::vector<NamedArray>& arrays, std::vector<NodalOption> nodal) {
  CarriedValues carried;
  for (const NamedArray& array : arrays) {
    const auto is_same = [&array](const NodalOption& option) { return option.name == array.name; };
    if (std::any_of(nodal.begin(), nodal.end(), is_same)) continue;
    if (const std::string why = excluded(array, nodal); !why.empty()) {
      carried.warnings.push_back("values that the file has are not written: " + why);
      continue;
    }
    carried.values.push_back({array.name, *array.values});
    nodal.push_back({array.name, {}});
  }
  return carried;
}

Result<ExitCode> convert_mesh(const ConvertOptions& options, const std::stop_token& stop) {
  auto output =
      MeshOutput::open({.files = {options.output}, .writing = options.writing, .has_values = true},
                       options.input, stop);
  if (!output) return tl::unexpected(output.error());
  auto read = read_mesh_with_arrays(options.input);
  if (!read) return tl::unexpected(read.error());
  Mesh& mesh = read->mesh;
  turn_counter_clockwise(mesh);
  if (auto named = set_names(options.names.names, mesh.names); !named)
    return tl::unexpected(named.error());
  if (auto found = output->find_markers(mesh.names.markers, mesh.open_markers); !found)
    return tl::unexpected(found.error());
  const auto [values, losses] = carried(read->arrays, options.writing.nodal);
  MeshView view = mesh.view();
  view.vertex_values = values;
  const v1::Summary none;
  if (auto written = output->write(view, none); !written) return tl::unexpected(written.error());
  std::vector<Warning> warnings;
  add(WarningKind::kNotWritten, losses, warnings);
  if (mesh.cut_faces > 0)
    warnings.push_back({.kind = WarningKind::kCutFaces,
                        .file = options.input.string(),
                        .count = mesh.cut_faces,
                        .text = with_separators(mesh.cut_faces) +
                                (mesh.cut_faces == 1 ? " face" : " faces") +
                                " of more than three corners, cut into triangles"});
  warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
  add(WarningKind::kNotWritten, output->warnings(), warnings);
  add(WarningKind::kOpenBoundary,
      open_boundary_warnings(markers_of(view), output->options().writing.open_boundaries),
      warnings);
  std::FILE* const to = output->options().text_stream();
  if (options.json)
    return print(json_line({{"triangles", view.triangle_count()},
                            {"vertices", view.vertex_count()},
                            {"warnings", warnings_json(warnings)}}),
                 to);
  if (options.quiet) return ExitCode::kOk;
  return print(with_separators(view.triangle_count()) + " triangles, " +
                   with_separators(view.vertex_count()) + " vertices\n" + output->text(none) +
                   warnings_text(warnings),
               to);
}

Json domain_json(const Domain& domain, const std::optional<CoordinateSystem>& system) {
  Json json = {{"points", domain.points.size()},
               {"segments", domain.segments.size()},
               {"holes", domain.holes.size()},
               {"regions", domain.regions.size()},
               {"areas", domain.areas.size()}};
  if (system) json["coordinates"] = {{"name", system->name}, {"geographic", system->geographic}};
  json["warnings"] = warnings_json(domain.warnings);
  return json;
}

// A line on the system of the coordinates, if the file says one.
std::string system_text(const std::optional<CoordinateSystem>& system) {
  if (!system) return "";
  return "coordinates: " + std::string(system->geographic ? "longitude and latitude" : "a plane") +
         " (" + harmless(system->name) + ")\n";
}

Result<ExitCode> convert_domain(const ConvertOptions& options, std::stop_token stop) {
  std::error_code ignored;
  if (std::filesystem::equivalent(options.input, options.output, ignored))
    return fail(ExitCode::kUsage, options.output.string() + ": would replace the input");
  if (options.writing != MeshWriteOptions{} || !options.names.names.empty())
    return fail(ExitCode::kUsage,
                "--names, --order, --msh-version, --open-boundary, --nodal, --renumber and --parts "
                "are for meshes, " +
                    options.output.string() + " is a domain");
  std::vector<OutputFile> files;
  auto file = OutputFile::create(options.output, std::move(stop));
  if (!file) return tl::unexpected(file.error());
  files.push_back(std::move(*file));
  auto read = read_domain(options.input, options.layers);
  if (!read) return tl::unexpected(read.error());
  const bool is_message = lower_extension(options.output) == kMessage;
  const std::optional<CoordinateSystem> system = read->system;
  auto domain = is_message ? std::move(read) : seeded(std::move(*read));
  if (!domain)
    return fail(domain.error().exit, options.input.string() + ": " + domain.error().message);
  if (is_message)
    files[0].put(make_request(*domain, {}).domain().SerializeAsString());
  else
    write_triangle_poly(*domain, files[0]);
  if (auto done = commit(files); !done) return tl::unexpected(done.error());
  if (!is_message && system && system->geographic)
    domain->warnings.push_back(
        {.kind = WarningKind::kCoordinates,
         .file = options.output.string(),
         .text = "does not say that its coordinates are longitudes and latitudes (" + system->name +
                 "); mesh it with --lonlat"});
  std::FILE* const to = options.output == kStandardOutput ? stderr : stdout;
  if (options.json) return print(json_line(domain_json(*domain, system)), to);
  if (options.quiet) return ExitCode::kOk;
  return print(with_separators(domain->points.size()) + " points, " +
                   with_separators(domain->segments.size()) + " segments, " +
                   with_separators(domain->holes.size()) + " holes, " +
                   with_separators(domain->regions.size()) + " regions" +
                   (is_message ? ", " + with_separators(domain->areas.size()) + " areas" : "") +
                   "\n" + system_text(system) + "wrote " + options.output.string() + "\n" +
                   warnings_text(domain->warnings),
               to);
}

}  // namespace

Result<ExitCode> run_convert(const ConvertOptions& options, std::stop_token stop) {
  const std::string extension = lower_extension(options.output);
  if (auto ok = check_has_format(options.output, ".poly, .pb, " + written_mesh_extensions()); !ok)
    return tl::unexpected(ok.error());
  const bool to_domain = extension == ".poly" || extension == kMessage;
  if (!is_domain_path(options.input)) return unknown_domain_format(options.input);
  if (to_domain) return convert_domain(options, std::move(stop));
  if (!is_mesh_output(options.output))
    return fail(ExitCode::kUsage,
                options.output.string() + ": the extension " +
                    in_quotes(extension_of(options.output)) +
                    " is not that of a domain that is written: .poly, .pb; nor of a "
                    "mesh that is written: " +
                    written_mesh_extensions());
  if (!is_mesh_input(options.input))
    return fail(ExitCode::kUsage, options.input.string() +
                                      ": is a domain; to mesh it: `weft mesh " +
                                      options.input.string() + " -o " + options.output.string() +
                                      "`; to convert it, write a .poly file or a .pb file");
  if (options.layers.wanted())
    return fail(ExitCode::kUsage, "--layer, --where and --attribute are for domains, " +
                                      options.input.string() + " is a mesh");
  return convert_mesh(options, stop);
}

}  // namespace weft::client
