// SPDX-License-Identifier: Apache-2.0
#include "client/commands/download.h"

#include <cstdint>
#include <optional>
#include <utility>

#include "client/call/fetch_mesh.h"
#include "client/call/mesh_request.h"
#include "client/report/job_text.h"
#include "client/report/marker_warnings.h"
#include "client/report/watch_job.h"

namespace weft::client {

Result<v1::Job> wait_for_job(JobServer& server, const std::string& id, ProgressBar& progress) {
  return watch_job(server, id, [&progress](const v1::Job& job) {
    if (!is_final(job.state())) progress.update(progress_of(job));
  });
}

Result<MeshReport> download(JobServer& server, const v1::Job& job, const InputDomain* input,
                            MeshOutput& output, ProgressBar& progress, MeshTimes& times) {
  const auto spool = output.make_spool();
  if (!spool) return tl::unexpected(spool.error());
  FetchMeshOptions options;
  if (input != nullptr)
    options.domain = DomainCounts{input->domain.points.size(), input->domain.segments.size()};
  options.on_triangles = [&](std::uint64_t triangles) {
    v1::Progress arrived;
    arrived.set_stage(v1::STAGE_EMIT);
    arrived.set_triangles(triangles);
    if (const std::uint64_t all = job.summary().triangles(); all > 0) {
      arrived.set_expected_triangles(all);
      arrived.set_fraction(static_cast<double>(triangles) / static_cast<double>(all));
    }
    progress.update(arrived);
  };
  auto report = fetch_mesh(server, job.id(), **spool, options);
  if (!report) return report;
  times.received = MeshTimes::Clock::now();

  auto mesh = (*spool)->view();
  if (!mesh) return tl::unexpected(mesh.error());
  const Names names =
      input != nullptr ? input->domain.names : names_of(report->summary.request().domain());
  mesh->names = &names;
  if (auto found = output.find_markers(names.markers); !found) return tl::unexpected(found.error());
  output.set_periodic(report->summary.request().quality());
  if (input != nullptr) {
    add_projection(*input, *report);
    if (auto set = output.set_domain(input->domain, input->projection); !set)
      return tl::unexpected(set.error());
    mesh->input_point_markers = input->domain.point_markers;
  }
  if (auto ok = add_outside_warning(input, *report); !ok) return tl::unexpected(ok.error());
  // 0 if the job has no such budget, or an earlier version of the server stored its mesh.
  if (auto warning =
          budget_warning(report->summary, report->summary.request().budget().max_triangles()))
    add_warnings({std::move(*warning)}, *report);
  add_marker_warnings(*mesh, output.options().writing.open_boundaries,
                      input != nullptr ? &input->domain : nullptr, *report);
  if (output.drawing() != nullptr) progress.say("drawing");
  if (auto written = output.write(*mesh, report->summary); !written)
    return tl::unexpected(written.error());
  add_warnings(output.warnings(), *report);
  times.written = MeshTimes::Clock::now();
  progress.clear();
  return report;
}

Json download_json(const v1::Job& job, const MeshReport& report, const MeshTimes& times) {
  Json json = {{"id", job.id()}};
  json.update(mesh_json(report, times));
  return json;
}

}  // namespace weft::client
