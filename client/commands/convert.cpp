// SPDX-License-Identifier: Apache-2.0
// `weft convert`: a mesh into another format, or a domain into a .poly file.
#include <string>
#include <utility>

#include "client/base/text.h"
#include "client/commands/commands.h"
#include "client/formats/domain_formats.h"
#include "client/formats/domains/seeded.h"
#include "client/formats/mesh_formats.h"
#include "client/formats/triangle/triangle_poly.h"
#include "client/report/marker_warnings.h"

namespace weft::client {
namespace {

bool is_mesh_input(const std::filesystem::path& path) {
  return is_domain_path(path) && !is_plain_domain_path(path);
}

bool is_mesh_output(const std::filesystem::path& path) {
  const MeshFormat* format = mesh_format(path);
  return format != nullptr && format->write != nullptr;
}

// Some programs number triangles clockwise; ours and most others do not.
void turn_counter_clockwise(Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) {
      return &mesh.coordinates[2 * std::size_t{mesh.triangles[t + k]}];
    };
    const double* a = at(0);
    const double* b = at(1);
    const double* c = at(2);
    if ((b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]))
      std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
  }
}

Result<ExitCode> convert_mesh(const ConvertOptions& options, const std::stop_token& stop) {
  auto output = MeshOutput::open({.files = {options.output}, .writing = options.writing},
                                 options.input, stop);
  if (!output) return tl::unexpected(output.error());
  auto mesh = read_mesh(options.input);
  if (!mesh) return tl::unexpected(mesh.error());
  turn_counter_clockwise(*mesh);
  const v1::Summary none;
  if (auto written = output->write(mesh->view(), none); !written)
    return tl::unexpected(written.error());
  if (options.quiet) return ExitCode::kOk;
  std::string warnings;
  for (const std::string& warning :
       open_boundary_warnings(markers_of(mesh->view()), options.writing.open_boundaries))
    warnings += "WARNING: " + warning + "\n";
  return print(with_separators(mesh->view().triangle_count()) + " triangles, " +
               with_separators(mesh->view().vertex_count()) + " vertices\n" + output->text(none) +
               warnings);
}

Result<ExitCode> convert_domain(const ConvertOptions& options, std::stop_token stop) {
  std::error_code ignored;
  if (std::filesystem::equivalent(options.input, options.output, ignored))
    return fail(ExitCode::kUsage, options.output.string() + ": would replace the input");
  if (options.writing != MeshWriteOptions{})
    return fail(ExitCode::kUsage, "--order, --msh-version and --open-boundary are of meshes, " +
                                      options.output.string() + " is a domain");
  std::vector<OutputFile> files;
  auto file = OutputFile::create(options.output, std::move(stop));
  if (!file) return tl::unexpected(file.error());
  files.push_back(std::move(*file));
  auto read = read_domain(options.input);
  if (!read) return tl::unexpected(read.error());
  const auto domain = seeded(std::move(*read));
  if (!domain)
    return fail(domain.error().exit, options.input.string() + ": " + domain.error().message);
  write_triangle_poly(*domain, files[0]);
  if (auto done = commit(files); !done) return tl::unexpected(done.error());
  if (options.quiet) return ExitCode::kOk;
  return print(with_separators(domain->points.size()) + " points, " +
               with_separators(domain->segments.size()) + " segments, " +
               with_separators(domain->holes.size()) + " holes, " +
               with_separators(domain->regions.size()) + " regions\nwrote " +
               options.output.string() + "\n");
}

}  // namespace

Result<ExitCode> run_convert(const ConvertOptions& options, std::stop_token stop) {
  const bool to_domain = lower_extension(options.output) == ".poly";
  if (!is_domain_path(options.input)) return unknown_domain_format(options.input);
  if (to_domain) return convert_domain(options, std::move(stop));
  if (!is_mesh_output(options.output))
    return fail(ExitCode::kUsage, options.output.string() + ": the extension " +
                                      in_quotes(options.output.extension().string()) +
                                      " is not that of a domain that is written: .poly; nor of a "
                                      "mesh that is written: " +
                                      written_mesh_extensions());
  if (!is_mesh_input(options.input))
    return fail(ExitCode::kUsage, options.input.string() +
                                      ": is a domain, which becomes a mesh by `weft mesh " +
                                      options.input.string() + " -o " + options.output.string() +
                                      "`; converted, it becomes a .poly file");
  return convert_mesh(options, stop);
}

}  // namespace weft::client
