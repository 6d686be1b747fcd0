// SPDX-License-Identifier: Apache-2.0
#include "client/commands/mesh_into.h"

#include <filesystem>
#include <utility>
#include <vector>

#include "client/call/mesh_spool.h"
#include "client/report/marker_warnings.h"
#include "client/report/size_warnings.h"

namespace weft::client {
namespace {

void add(std::vector<std::string> warnings, MeshReport& report) {
  for (std::string& warning : warnings) report.warnings.push_back(std::move(warning));
}

}  // namespace

Result<MeshReport> mesh_into(const Connection& connection, const InputDomain& input,
                             const RequestOptions& request_options, const MeshCallOptions& call,
                             MeshOutput* output, const std::function<void()>& received,
                             std::stop_token stop) {
  std::error_code ignored;
  const auto spool = output != nullptr
                         ? output->make_spool()
                         : MeshSpool::create(std::filesystem::temp_directory_path(ignored));
  if (!spool) return tl::unexpected(spool.error());
  auto report =
      call_generate_mesh(connection, input.domain, request_options, call, **spool, std::move(stop));
  if (!report) {
    Error error = report.error();
    constexpr int kUnavailable = 14;
    if (connection.server && error.exit == exit_code_of_status(kUnavailable))
      error.message += "\n  its last lines:\n" + connection.server->last_log_lines();
    return tl::unexpected(in_plane(std::move(error), input));
  }
  received();
  add_projection(input, *report);
  if (auto warning = budget_warning(report->summary, request_options.max_triangles))
    add({std::move(*warning)}, *report);
  add(request_options.warnings, *report);
  add(size_warnings(*request_options.size_read, input.domain), *report);
  if (output == nullptr) return report;
  output->bring_back_by(input.projection);
  auto mesh = (*spool)->view();
  if (!mesh) return tl::unexpected(mesh.error());
  mesh->input_point_markers = input.domain.point_markers;
  report->markers = markers_of(*mesh);
  add(open_boundary_warnings(report->markers, output->options().writing.open_boundaries), *report);
  add(hidden_marker_warnings(report->markers, input.domain), *report);
  if (auto written = output->write(*mesh, report->summary); !written)
    return tl::unexpected(written.error());
  return report;
}

}  // namespace weft::client
