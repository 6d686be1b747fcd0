// SPDX-License-Identifier: Apache-2.0
// `weft top`: the caller's jobs and the server's throughput, live on a terminal.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "client/commands/commands.h"
#include "client/commands/job_commands.h"
#include "client/report/terminal_screen.h"
#include "client/report/top_view.h"

namespace weft::client {
namespace {

using Clock = std::chrono::steady_clock;

Result<TopSample> look(JobServer& server) {
  constexpr std::size_t kMaxEnded = 500;
  auto info = server.info();
  if (!info) return tl::unexpected(info.error());
  auto open = server.list({v1::JOB_STATE_QUEUED, v1::JOB_STATE_RUNNING}, std::nullopt);
  if (!open) return tl::unexpected(open.error());
  // Asks for each state by itself, so that many jobs that succeeded do not hide one that failed.
  std::vector<v1::Job> ended;
  std::set<v1::JobState> left_out;
  for (const v1::JobState state :
       {v1::JOB_STATE_SUCCEEDED, v1::JOB_STATE_FAILED, v1::JOB_STATE_CANCELLED}) {
    auto jobs = server.list({state}, kMaxEnded);
    if (!jobs) return tl::unexpected(jobs.error());
    if (jobs->size() == kMaxEnded) left_out.insert(state);
    std::ranges::move(*jobs, std::back_inserter(ended));
  }
  const double now = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  TopSample sample = top_sample(now, std::move(*info), std::move(*open), std::move(ended));
  sample.left_out = std::move(left_out);
  return sample;
}

// The server is away or slow, or ends while it answers, and may answer the next time.
bool may_pass(const Error& error) {
  constexpr int kCancelled = 1;
  constexpr int kDeadlineExceeded = 4;
  constexpr int kUnavailable = 14;
  return error.exit == exit_code_of_status(kCancelled) ||
         error.exit == exit_code_of_status(kDeadlineExceeded) ||
         error.exit == exit_code_of_status(kUnavailable);
}

}  // namespace

Result<ExitCode> run_top(const TopOptions& options, std::stop_token stop) {
  auto server = JobServer::connect(options.calls, stop);
  if (!server) return tl::unexpected(server.error());
  TopView view(server->connection().address);
  auto sample = look(*server);
  if (!sample) return tl::unexpected(sample.error());
  view.add(std::move(*sample));
  if (options.once || ::isatty(STDOUT_FILENO) == 0) return print(view.text(std::nullopt));

  TerminalScreen screen;
  server->on_away([](const std::string&) {});
  const auto interval = std::chrono::ceil<std::chrono::milliseconds>(
      std::chrono::duration<double>(options.interval_seconds));
  while (screen.show(view.text(screen.size())) && screen.wait(interval, stop)) {
    server->set_limits(1, options.calls.timeout_seconds);
    sample = look(*server);
    if (stop.stop_requested()) break;
    if (!sample && !may_pass(sample.error())) return tl::unexpected(sample.error());
    view.set_problem(sample ? "" : sample.error().message);
    if (sample) view.add(std::move(*sample));
  }
  if (stop.stop_requested()) return fail(ExitCode::kInternal, "interrupted");
  return ExitCode::kOk;
}

}  // namespace weft::client
