// SPDX-License-Identifier: Apache-2.0
// `weft fetch`: brings the mesh of a job that succeeded into files and drawings.
#include <optional>

#include "client/commands/commands.h"
#include "client/commands/download.h"
#include "client/commands/input_domain.h"
#include "client/commands/job_commands.h"
#include "client/report/job_text.h"
#include "client/report/mesh_text.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {
namespace {

Result<std::optional<InputDomain>> read_submitted(const FetchOptions& options) {
  const ProjectionOptions& projected = options.output.projection;
  if (!options.domain && projected.wanted())
    return fail(ExitCode::kUsage,
                "the job has its mesh in metres; to write it in longitude and latitude, give the "
                "domain that was submitted, too: --domain INPUT");
  if (!options.domain && options.layers.wanted())
    return fail(ExitCode::kUsage,
                "--layer, --where and --attribute are for the domain: give --domain INPUT, too");
  if (!options.domain) return std::nullopt;
  if (!is_domain_path(*options.domain)) return unknown_domain_format(*options.domain);
  auto domain = read_input_domain(*options.domain, {}, projected, options.layers);
  if (!domain) return tl::unexpected(domain.error());
  return std::move(*domain);
}

}  // namespace

Result<ExitCode> run_fetch(const FetchOptions& options, std::stop_token stop) {
  MeshTimes times;
  auto output = MeshOutput::open(options.output, options.domain, stop);
  if (!output) return tl::unexpected(output.error());
  auto server = JobServer::connect(options.calls, stop);
  if (!server) return tl::unexpected(server.error());
  const auto submitted = read_submitted(options);
  if (!submitted) return tl::unexpected(submitted.error());
  const InputDomain* input = *submitted ? &**submitted : nullptr;
  times.read = times.connected = MeshTimes::Clock::now();

  ProgressBar progress(stderr, options.quiet ? ProgressStyle::kNone : progress_style_of(stderr));
  server->on_away([&progress](const std::string& what) { progress.say(what); });
  const auto job =
      options.wait ? wait_for_job(*server, options.id, progress) : server->get(options.id);
  if (!job) return tl::unexpected(job.error());
  if (auto error = job_error(*job, input != nullptr ? origin_of(*input) : RequestOrigin())) {
    if (!is_final(job->state())) error->message += ". --wait waits for it";
    return tl::unexpected(*error);
  }
  const auto report = download(*server, *job, input, *output, progress, times);
  if (!report) return tl::unexpected(report.error());
  std::FILE* const to = options.output.text_stream();
  if (options.json) return print(json_line(download_json(*job, *report, times)), to);
  return options.quiet ? ExitCode::kOk
                       : print(mesh_text(*report, times) + output->text(report->summary), to);
}

}  // namespace weft::client
