// SPDX-License-Identifier: Apache-2.0
#include "client/commands/mesh_into.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "client/report/marker_warnings.h"
#include "client/report/mesh_text.h"
#include "files/message/mesh_spool.h"

namespace weft::client {

MeshCallOptions shown_call(const CallOptions& calls, ProgressBar& progress,
                           const DomainProjection* projection) {
  return {.timeout_seconds = calls.timeout_seconds,
          .retries = calls.retries,
          .on_progress = [&progress](const v1::Progress& p) { progress.update(p); },
          .on_away =
              [&progress](const std::string& what) {
                progress.clear();
                std::fprintf(stderr, "weft: %s\n", what.c_str());
              },
          .projection = projection};
}

Result<MeshReport> mesh_into(const Connection& connection, const InputDomain& input,
                             const RequestOptions& request_options, const MeshCallOptions& call,
                             MeshOutput* output, const std::function<void()>& received,
                             std::stop_token stop) {
  if (output != nullptr) {
    if (auto found = output->find_markers(input.domain.names.markers); !found)
      return tl::unexpected(found.error());
    if (auto set = output->set_domain(input.domain, input.projection); !set)
      return tl::unexpected(set.error());
  }
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
    return tl::unexpected(std::move(error));
  }
  received();
  add_projection(input, *report);
  add_warnings(sentences(input.domain.warnings), *report);
  if (auto ok = add_outside_warning(&input, *report); !ok) return tl::unexpected(ok.error());
  if (auto warning =
          budget_warning(report->summary, request_options.asked.budget().max_triangles()))
    add_warnings({std::move(*warning)}, *report);
  add_warnings(request_options.warnings, *report);
  if (output == nullptr) return report;
  output->set_periodic(request_options.asked.quality());
  auto mesh = (*spool)->view();
  if (!mesh) return tl::unexpected(mesh.error());
  mesh->input_point_markers = input.domain.point_markers;
  mesh->names = &input.domain.names;
  add_marker_warnings(*mesh, output->options().writing.open_boundaries, &input.domain, *report);
  if (auto written = output->write(*mesh, report->summary); !written)
    return tl::unexpected(written.error());
  add_warnings(output->warnings(), *report);
  return report;
}

}  // namespace weft::client
