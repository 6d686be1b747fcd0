// SPDX-License-Identifier: Apache-2.0
// `weft mesh`: reads a domain, has it meshed, writes files and drawings.
#include "client/commands/commands.h"
#include "client/formats/domain_formats.h"
#include "client/formats/mesh_formats.h"
#include "client/mesh_into.h"
#include "client/progress_bar.h"

namespace weft::client {

Result<ExitCode> run_mesh(const MeshOptions& options, std::stop_token stop) {
  MeshTimes times;
  if (!is_domain_path(options.input)) return unknown_domain_format(options.input);
  auto output = MeshOutput::open(options.output, options.input, stop);
  if (!output) return tl::unexpected(output.error());
  const auto domain = read_domain(options.input);
  if (!domain) return tl::unexpected(domain.error());
  auto wishes = with_size_grid(options.wishes);
  if (!wishes) return tl::unexpected(wishes.error());
  times.read = MeshTimes::Clock::now();

  const auto connection = connect(options.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  times.connected = MeshTimes::Clock::now();

  ProgressBar progress(stderr, options.quiet ? ProgressStyle::kNone : progress_style_of(stderr));
  const MeshCallOptions call{
      .timeout_seconds = options.timeout_seconds,
      .on_progress = [&progress](const v1::Progress& p) { progress.update(p); }};
  wishes->quadtree = options.output.draw_quadtree;
  const auto received = [&] {
    times.received = MeshTimes::Clock::now();
    if (output->draws()) progress.say("drawing");
  };
  const auto report = mesh_into(*connection, *domain, *wishes, call, &*output, received, stop);
  if (!report) return tl::unexpected(report.error());
  times.written = MeshTimes::Clock::now();
  progress.clear();

  if (options.json) {
    Json json = mesh_json(*report, times);
    if (!domain->region_values.empty())
      json["region_values"] = region_values_json(domain->region_values);
    return print(json_line(json));
  }
  if (options.quiet) return ExitCode::kOk;
  return print(mesh_text(*report, times) + region_values_text(domain->region_values) +
               output->text(report->summary));
}

}  // namespace weft::client
