// SPDX-License-Identifier: Apache-2.0
// `weft submit`, and `weft mesh --detach`: submits a job that makes a mesh. Prints the
// job's id alone, so that a script can take it.
#include <cstdio>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "client/commands/commands.h"
#include "client/commands/download.h"
#include "client/commands/input_domain.h"
#include "client/commands/job_commands.h"
#include "client/report/job_text.h"
#include "client/report/mesh_text.h"
#include "files/base/text.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {
namespace {

// With this id a submission whose answer was lost can be sent again.
std::string random_request_id() {
  std::random_device random;
  char id[48];
  std::snprintf(id, sizeof id, "weft-%08x%08x%08x%08x", random(), random(), random(), random());
  return id;
}

Result<std::optional<MeshOutput>> open_output(const SubmitOptions& options,
                                              const std::stop_token& stop) {
  const MeshOutputOptions& output = options.output;
  if (output.empty() && !output.draw_quadtree) return std::nullopt;
  if (!options.wait)
    return fail(ExitCode::kUsage,
                "nothing is written before the job has ended: give --wait, or fetch the mesh later "
                "with `weft fetch`");
  auto opened = MeshOutput::open(output, options.input, stop);
  if (!opened) return tl::unexpected(opened.error());
  return std::move(*opened);
}

void warn(const std::vector<std::string>& warnings, bool quiet) {
  if (quiet) return;
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "weft: WARNING: %s\n", warning.c_str());
}

Result<v1::Job> submit(JobServer& server, const InputDomain& input, const SubmitOptions& options) {
  const Domain& domain = input.domain;
  if (auto ok = check_sendable(domain); !ok) return tl::unexpected(ok.error());
  auto request_options = with_size(options.request_options, domain, input.projection.get());
  if (!request_options) return tl::unexpected(request_options.error());
  warn(request_options->warnings, options.quiet);
  request_options->asked.set_want_quadtree(options.output.draw_quadtree);
  request_options->asked.clear_no_cache();  // a job has its own field for this
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = make_request(domain, *request_options);
  request.set_request_id(options.request_id.empty() ? random_request_id() : options.request_id);
  request.set_notify(options.notify);
  request.set_no_cache(options.request_options.asked.no_cache());
  auto job = server.submit(request, origin_of(input, &options.request_options));
  if (job) return job;
  Error error = job.error();
  constexpr int kUnavailable = 14;
  if (error.exit == exit_code_of_status(kUnavailable))
    error.message += "\n  it may have been accepted nevertheless; with --request-id " +
                     in_quotes(request.request_id()) + " it is not made twice";
  return tl::unexpected(error);
}

}  // namespace

Result<ExitCode> run_submit(const SubmitOptions& options, std::stop_token stop) {
  MeshTimes times;
  if (!is_domain_path(options.input)) return unknown_domain_format(options.input);
  auto output = open_output(options, stop);
  if (!output) return tl::unexpected(output.error());
  auto server = JobServer::connect(options.calls, stop);
  if (!server) return tl::unexpected(server.error());
  const auto input = read_input_domain(options.input, options.request_options,
                                       options.output.projection, options.layers);
  if (!input) return tl::unexpected(input.error());
  const Domain& domain = input->domain;
  warn(sentences(domain.warnings), options.quiet);
  times.read = times.connected = MeshTimes::Clock::now();

  if (*output)
    if (auto set = (*output)->set_domain(input->domain, input->projection); !set)
      return tl::unexpected(set.error());
  auto job = submit(*server, *input, options);
  if (!job) return tl::unexpected(job.error());
  std::FILE* const to = options.output.text_stream();
  const auto print_id = [&] { return print(harmless(job->id()) + "\n", to); };
  if (!options.wait) return options.json ? print(json_line(job_json(*job)), to) : print_id();
  if (!options.json)
    if (auto printed = print_id(); !printed) return printed;

  ProgressBar progress(stderr, options.quiet ? ProgressStyle::kNone : progress_style_of(stderr));
  server->on_away([&progress](const std::string& what) { progress.say(what); });
  if (!is_final(job->state())) {
    job = wait_for_job(*server, job->id(), progress);
    if (!job) return tl::unexpected(job.error());
  }
  const auto failed = job_error(*job, origin_of(*input, &options.request_options));
  if (failed || !*output) {
    progress.clear();
    if (options.json)
      if (auto printed = print(json_line(job_json(*job)), to); !printed) return printed;
    if (failed) return tl::unexpected(*failed);
    MeshReport report{.accepted = {}, .summary = job->summary()};
    add_projection(*input, report);
    if (auto ok = add_outside_warning(&*input, report); !ok) return tl::unexpected(ok.error());
    if (!options.quiet)
      std::fputs((summary_text(report.summary) + warnings_text(report.summary)).c_str(), stderr);
    return ExitCode::kOk;
  }
  const auto report = download(*server, *job, &*input, **output, progress, times);
  if (!report) return tl::unexpected(report.error());
  if (options.json) return print(json_line(download_json(*job, *report, times)), to);
  if (!options.quiet)
    std::fputs((mesh_text(*report, times) + (*output)->text(report->summary)).c_str(), stderr);
  return ExitCode::kOk;
}

}  // namespace weft::client
