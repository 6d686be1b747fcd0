// SPDX-License-Identifier: Apache-2.0
// `weft watch`: follows a job to its end, which is also that of the command.
#include "client/commands/commands.h"
#include "client/commands/download.h"
#include "client/commands/job_commands.h"
#include "client/report/job_text.h"
#include "client/report/mesh_text.h"
#include "client/report/watch_job.h"

namespace weft::client {

Result<ExitCode> run_watch(const JobOptions& options, std::stop_token stop) {
  std::stop_source unreadable;  // requested if stdout is gone: nobody watches any more
  const std::stop_callback stopped(stop, [&unreadable] { unreadable.request_stop(); });
  auto server = JobServer::connect(options.calls, unreadable.get_token());
  if (!server) return tl::unexpected(server.error());

  Result<v1::Job> job;
  if (options.json) {
    Result<ExitCode> printed = ExitCode::kOk;
    job = watch_job(*server, options.id, [&](const v1::Job& now) {
      if (printed) printed = print(json_line(job_json(now)));
      if (!printed) unreadable.request_stop();
    });
    if (!printed) return printed;
  } else {
    ProgressBar progress(stdout, progress_style_of(stdout));
    server->on_away([&progress](const std::string& what) { progress.say(what); });
    job = wait_for_job(*server, options.id, progress);
  }
  if (!job) return tl::unexpected(job.error());
  if (const auto error = job_error(*job)) return tl::unexpected(*error);
  if (options.json) return ExitCode::kOk;
  if (!job->has_summary()) return print("succeeded\n");
  return print(summary_text(job->summary()) + warnings_text(job->summary()));
}

}  // namespace weft::client
